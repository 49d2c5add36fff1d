// 03  A rigid body: the same equations on a group.
//
// One learns: that positions may be left out. A free body looks alike from every attitude, so that one turn g of SO(3)
// is all of a step; SO(3) is a groupoid over a single point, and the discrete Euler-Lagrange equation becomes Euler's:
//
//     L(g) = h l(log(g) / h),  l(w) = w.I w / 2;    M' = Ad*_g M            [G] (7), the discrete Lie-Poisson equations
//
// M is the momentum seen from the body. Its turn into space, A M with A the product of all g, does not change: kept to
// round-off, while the energy stays in a band. Thrown about its middle axis the body flips, again and again.
//
// Run: ninja -C build/release 03_rigid_body && build/release/bin/03_rigid_body
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <memory>
#include <vector>

using namespace lagroid;
using Three = Vector<double, 3>;

struct Body : System<Body, SO3> {
  double h = 0.02;
  Three inertia{1, 2, 3};
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<S, 3> angle = SO3::log(g);
    return angle.cwiseAbs2().dot(inertia.cast<S>()) * (0.5 / h);
  }
  std::vector<Quantity<Body>> quantities() const {
    const auto energy = [inverse = Three(inertia.cwiseInverse())](const TrajectoryPoint<Body>& point, double* out) {
      *out = 0.5 * point.state.momentum.cwiseAbs2().dot(inverse);
    };
    const auto spatial = [](const TrajectoryPoint<Body>& point, double* out) {
      Three::Map(out) = point.configuration * point.state.momentum;
    };
    return {{"energy", {"H"}, Promise::bounded, /*needs_step=*/false, energy},
            {"momentum in space", {"x", "y", "z"}, Promise::conserved, /*needs_step=*/false, spatial}};
  }
};

int main() {
  const Body body;
  const State<SO3> start{{}, {0.01, 2, 0}};  // no position, and a spin that is a little off the middle axis
  FixedStepIntegrator<Body> integrator(body, start, SO3::unit(start.object), std::make_unique<NewtonStep<Body>>());
  bool upright = true;
  while (integrator.point().time < 100) {
    if (!integrator.advance().converged()) return 1;
    const double along = integrator.point().state.momentum(1);
    if ((along > 0) == upright) continue;
    upright = !upright;
    fmt::print("t = {:4.1f}: the middle axis points {}\n", integrator.point().time, upright ? "up" : "down");
  }
  for (const LedgerEntry& entry : run(body, start, {.steps = 5000}).ledger.entries)
    fmt::print("{:<18} {:<10} {}\n", entry.name, entry.promise, entry.verdict);
  return 0;
}
