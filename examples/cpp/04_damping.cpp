// 04  Damping, and what the ledger then says.
//
// One learns: how forces are written, and how a quantity that changes can still be promised. A spring pulls a mass in
// the plane to the centre, the air resists with -c v: an impulse -c (q1 - q0) on an arrow, by halves at either end.
//
//     -dL/dq0 - f-(g) = mu,    mu' = dL/dq1 + f+(g)            Marsden and West, Acta Numerica 2001, part 3
//
// Energy and angular momentum are lost, and a ledger that promises them says that they are. Less the work and the
// torque of the air they are what they were: the energy within its band, the angular momentum to round-off, whatever c
// is.
//
// Run: ninja -C build/release 04_damping && build/release/bin/04_damping
#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <cmath>
#include <vector>

using namespace lagroid;
using Point = Vector<double, 2>;

struct Oscillator : System<Oscillator, Pair<2>> {
  double h = 0.05;
  double c = 0.05;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> move = g.target - g.source;
    const Vector<S, 2> middle = (g.source + g.target) * 0.5;
    return move.squaredNorm() * (0.5 / h) - middle.squaredNorm() * (0.5 * h);
  }
  template <class S> Forces<S, 2> forces(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> half = (g.target - g.source) * (-0.5 * c);
    return {half, half};
  }
  static double energy(const State<Pair<2>>& z) { return 0.5 * (z.momentum.squaredNorm() + z.object.squaredNorm()); }
  std::vector<Quantity<Oscillator>> quantities() const {
    const Symmetry<Oscillator> turning("turning", [](const Point& q) { return Point(-q(1), q(0)); });
    const auto value = [](const TrajectoryPoint<Oscillator>& point, double* out) { *out = energy(point.state); };
    const auto size = [](const TrajectoryPoint<Oscillator>& point) { return energy(point.state); };
    return {{"energy", {"H"}, Promise::bounded, /*needs_step=*/false, value, size},
            energy_balance(*this),
            turning.quantity(),
            momentum_balance(*this, turning)};
  }
};

int main() {
  const Oscillator oscillator;
  const RunResult result = run(oscillator, {{1, 0}, {0, 0.5}}, {.steps = 1200});
  if (!result.converged()) return 1;
  for (const LedgerEntry& entry : result.ledger.entries)
    fmt::print("{:<30} {:6.3f} -> {:6.3f}   {:<9}  {}\n", entry.name, entry.initial[0], entry.final[0], entry.promise,
               entry.verdict);
  fmt::print("angular momentum by the differential equation: {:.3f}\n", 0.5 * std::exp(-oscillator.c * 60));
  return 0;
}
