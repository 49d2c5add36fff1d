// 07  A constraint on velocities: what competes makes the motion.
//
// One learns: that one constraint and one Lagrangian give two motions. A skate on a slope may glide along its blade but
// not across it, sin(a) dx = cos(a) dy, which no position forbids. Which variations are to respect that?
//
//     nonholonomic: the virtual displacements     -dL/dq0 - lambda omega(q0) = mu     bodies that roll and glide
//     vakonomic: the paths that compete           -d(L + lambda phi)/dq0 = mu         [G] (5): control at least cost
//
// A skate that is spun on a slope does not go down for long: it climbs back and drifts sideways, x = sin^2(w t) / (2
// w^2) (Bloch, Nonholonomic Mechanics and Control, 1.7). Both ledgers are without fault: which principle is nature's,
// neither the constraint nor its residual says.
//
// Run: ninja -C build/release 07_nonholonomic && build/release/bin/07_nonholonomic
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string_view>

using namespace lagroid;

// q = (x, y, a): x down the slope, y across it, a the direction of the blade. Unit mass, inertia and pull.
template <Principle P> struct Skate : System<Skate<P>, Pair<3>, /*arrow constraints*/ 1> {
  static constexpr Principle principle = P;
  double h = 0.01;
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> move = g.target - g.source;
    return move.squaredNorm() * (0.5 / h) + (g.source(0) + g.target(0)) * (0.5 * h);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 3>& g) const {
    using std::cos, std::sin;
    const S angle = (g.source(2) + g.target(2)) * 0.5;
    return Vector<S, 1>(sin(angle) * (g.target(0) - g.source(0)) - cos(angle) * (g.target(1) - g.source(1)));
  }
};

template <Principle P> void skate(std::string_view name) {
  const RunResult result = run(Skate<P>{}, {{0, 0, 0}, {0, 0, 1}}, {.steps = 1000});  // at rest, but for the spin
  const auto& q = result.final.position;
  fmt::print("{:<13} {}: {:.2f} down the slope and {:.2f} across it, the constraint {}\n", name, result.status, q[0],
             q[1], result.ledger.entries.front().verdict);
}

int main() {
  skate<Principle::nonholonomic>("nonholonomic");
  skate<Principle::vakonomic>("vakonomic");
  fmt::print("closed form: {:.2f} down the slope\n", 0.5 * std::pow(std::sin(10.0), 2));
  return 0;
}
