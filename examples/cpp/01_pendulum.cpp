// 01  A pendulum and its ledger.
//
// One learns: what a discrete Lagrangian is, how a motion is made of it, and what a ledger says. On the pair groupoid
// R x R an arrow g = (q0, q1) is one step, and L(q0, q1) its action over the time h. The momenta at its ends are
// -dL/dq0 and dL/dq1; consecutive steps meet in them:
//
//     d/dq L(q, q2) + d/dq L(q0, q) = 0            [G] Theorem 2.13, the discrete Euler-Lagrange equation
//
// The step is symplectic, so that the energy, which no step keeps, stays within a band; half the step makes a quarter
// of it. A ledger writes such a promise down beside what was found.
//
// Run: ninja -C build/release 01_pendulum && build/release/bin/01_pendulum
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <cmath>
#include <vector>

using namespace lagroid;

// A unit mass on a unit rod under unit gravity, q its angle from below, the potential taken at the middle of the arrow.
struct Pendulum : System<Pendulum, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    using std::cos;
    const S velocity = (g.target(0) - g.source(0)) / h;
    const S middle = (g.target(0) + g.source(0)) * 0.5;
    return (velocity * velocity * 0.5 + cos(middle)) * h;
  }
  static double energy(const State<Pair<1>>& z) { return 0.5 * z.momentum.squaredNorm() - std::cos(z.object(0)); }
  std::vector<Quantity<Pendulum>> quantities() const {
    const auto value = [](const TrajectoryPoint<Pendulum>& point, double* out) { *out = energy(point.state); };
    return {{"energy", {"H"}, Promise::bounded, /*needs_step=*/false, value}};
  }
};

int main() {
  const State<Pair<1>> start{Vector<double, 1>(2.5), Vector<double, 1>(0)};  // an angle and its momentum
  for (const double h : {0.1, 0.05}) {
    Pendulum pendulum;
    pendulum.h = h;
    const RunResult result = run(pendulum, start, {.steps = std::lround(100 / h)});
    if (!result.converged()) return 1;
    const LedgerEntry& energy = result.ledger.entries.front();
    fmt::print("h = {:4}  angle at t = {:.0f}: {:6.3f}   {} is {}, off by {:.1e} at most\n", h, result.final.time,
               result.final.position[0], energy.name, energy.verdict, energy.drift);
  }
  return 0;
}
