// A gyrostat of a user's own: a rigid body with three rotors, run with its ledger and its files.
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/run/run.hpp>

#include <cstdio>
#include <tuple>

using namespace lagroid;

// L = (<w, I w> + sum J_i (w_i + t_i)^2) / 2h, w the body's rotation over a step, t_i that of the rotor about axis i.
struct Gyrostat : System<Gyrostat, Product<SO3, SO2, SO2, SO2>> {
  double h = 0.05;
  Vector<double, 3> inertia{3, 2, 1};
  Vector<double, 3> rotors{0.4, 0.3, 0.2};

  template <class A, class T> auto lagrangian(const A& g, const T& step) const {
    const auto x = groupoid.tau_inverse(g);
    auto twice = x(0) * x(0) * inertia(0);
    for (int i = 1; i < 3; ++i) twice = twice + x(i) * x(i) * inertia(i);
    for (int i = 0; i < 3; ++i) twice = twice + (x(i) + x(3 + i)) * (x(i) + x(3 + i)) * rotors(i);
    return twice * 0.5 / step;
  }
  template <class A> auto lagrangian(const A& g) const { return lagrangian(g, h); }

  std::vector<Quantity<Gyrostat>> quantities() const {
    using Point = TrajectoryPoint<Gyrostat>;
    return {{"spatial momentum",
             {"m1", "m2", "m3"},
             Promise::conserved,
             false,
             [](const Point& p, double* out) {
               Eigen::Map<Vector<double, 3>>{out} = std::get<0>(p.configuration) * p.state.momentum.head<3>();
             }},
            {"rotor momenta", {"j1", "j2", "j3"}, Promise::conserved, false, [](const Point& p, double* out) {
               Eigen::Map<Vector<double, 3>>{out} = p.state.momentum.tail<3>();
             }}};
  }
};

int main(int argc, char** argv) {
  State<Gyrostat::GroupoidType> start;
  start.momentum << 0.3, 1.5, 0.4, 0.2, -0.1, 0.3;
  const RunResult result =
      run(Gyrostat{}, start, {.steps = 2000, .name = "gyrostat", .folder = argc > 1 ? argv[1] : ""});
  std::fputs(text_report(result).c_str(), stdout);
  bool kept = result.converged() && result.output_error.empty() && result.ledger.entries.size() == 3;
  for (const LedgerEntry& entry : result.ledger.entries)
    kept = kept && (entry.verdict == "kept" || entry.verdict == "bounded");
  return kept ? 0 : 1;
}
