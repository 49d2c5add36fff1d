// 02  A constraint and its multiplier.
//
// One learns: how a holonomic constraint is written, and that its multiplier is a physical number. The bob of a
// spherical pendulum moves in space, q in R^3, with C(q) = (|q|^2 - 1) / 2 = 0. The multiplier of C lives on the
// objects, where two arrows meet: the impulse of the rod there, which is -h times its tension.
//
//     -dL/dq0 (g) - lambda dC(q0) = mu,    C(q1) = 0            [G] (5) with C in the place of phi
//
// Two numbers check it: the tension |v|^2 - q3, with |v|^2 from the energy; and the momentum about the vertical, which
// Noether's theorem keeps ([G] Theorem 4.9).
//
// Run: ninja -C build/release 02_multiplier && build/release/bin/02_multiplier
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace lagroid;
using Point = Vector<double, 3>;

struct SphericalPendulum : System<SphericalPendulum, Pair<3>, /*arrow constraints*/ 0, /*object constraints*/ 1> {
  double h = 0.01;
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> move = g.target - g.source;
    return move.squaredNorm() * (0.5 / h) - (g.source(2) + g.target(2)) * (0.5 * h);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
  std::vector<Symmetry<SphericalPendulum>> symmetries() const {
    return {{"momentum about the vertical", [](const Point& q) { return Point(-q(1), q(0), 0); }}};
  }
};

int main() {
  const SphericalPendulum pendulum;
  const State<Pair<3>> start{{1, 0, 0}, {0, 0.5, 0}};  // the rod level, the bob pushed sideways
  FixedStepIntegrator<SphericalPendulum> integrator(pendulum, start, pendulum.groupoid.unit(start.object),
                                                    std::make_unique<NewtonStep<SphericalPendulum>>());
  double strongest = 0;
  double off = 0;
  for (int k = 0; k < 2000; ++k) {
    const Point before = integrator.point().state.object;
    if (!integrator.advance().converged()) return 1;
    const double tension = -integrator.point().step.multipliers(0) / pendulum.h;  // at `before`
    if (k > 0) off = std::max(off, std::abs(tension - (0.25 - 3 * before(2))));
    strongest = std::max(strongest, tension);
  }
  fmt::print("the rod pulls with {:.2f} at most, as the energy says to {:.0e}\n", strongest, off);
  for (const LedgerEntry& entry : run(pendulum, start, {.steps = 2000}).ledger.entries)
    fmt::print("{}: {}\n", entry.name, entry.verdict);
  return 0;
}
