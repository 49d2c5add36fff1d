// Exact derivatives of a run: how a bob on a spring ends, by its start, its mass and its stiffness; what a cost has for
// a gradient; and a formula that does not carry a derivative, refused.
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <fmt/format.h>

using namespace lagroid;

/// U = k (|q| - l)^2 / 2 + m g q2, in the plane.
struct Bob : MechanicalSystem<Bob, 2> {
  double bob_mass = 1;
  double stiffness = 40;
  double length = 1;

  static auto parameters() {
    return std::tuple(parameter("mass", &Bob::bob_mass, "kg", "of the bob", positive),
                      parameter("stiffness", &Bob::stiffness, "N/m", "of the spring", positive),
                      parameter("length", &Bob::length, "m", "at which it is slack", positive));
  }
  template <class S = double> ParameterScalar<S> mass() const { return varied<S>(bob_mass); }
  template <class S> S potential(const Vector<S, 2>& q) const {
    const S stretch = sqrt(q.squaredNorm()) - length;  // a plain number: no derivative by the length
    return stretch * stretch * (varied<S>(stiffness) * 0.5) + q(1) * (varied<S>(bob_mass) * 9.81);
  }
};

int main() {
  Bob bob;
  bob.h = 0.01;
  const State<Pair<2>> start = {{0.8, -0.9}, {0, 0}};

  const Sensitivities end = sensitivities(bob, start, {.steps = 200, .parameters = {"mass", "stiffness"}});
  fmt::print("height at the end by the stiffness: {:+.10f}\n", end.by_parameters(1, 1));
  fmt::print("the transition matrix keeps areas: |det| - 1 = {:.0e}\n", std::abs(end.by_start.determinant() - 1));
  fmt::print("derivatives grew {:.0f} times: {:.1f} digits are left\n", end.growth, end.digits_left);

  // The mean square of the height, integrated over the run, by both parameters and four numbers of the start, from one
  // run forwards and one in reverse that keeps ten states.
  const auto square = [](const auto& node) { return node.object(1) * node.object(1); };
  const RunGradient cost =
      gradient(bob, start, square,
               {.steps = 200, .parameters = {"mass", "stiffness"}, .observed = Observed::integral(), .budget = {10}});
  fmt::print("cost {:.6f}, by mass {:+.6f}, by stiffness {:+.6f}\n", cost.values(0), cost.by_parameters(0, 0),
             cost.by_parameters(0, 1));

  // The same by differences of runs.
  const auto cost_at = [&](double stiffness) {
    Bob other = bob;
    other.stiffness = stiffness;
    return gradient(other, start, square, {.steps = 200, .observed = Observed::integral()}).values(0);
  };
  const double difference = (cost_at(40.01) - cost_at(39.99)) / 0.02;
  fmt::print("by stiffness, differenced {:+.6f}\n", difference);

  try {
    sensitivities(bob, start, {.steps = 200, .parameters = {"length"}});
    return 1;
  } catch (const WithoutDerivative& refusal) {
    fmt::print("{}\n", refusal.what());
  }
  return std::abs(difference - cost.by_parameters(0, 1)) < 1e-6 ? 0 : 1;
}
