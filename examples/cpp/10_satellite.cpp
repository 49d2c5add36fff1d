// 10  A groupoid, a constrained system, its reduction and its boundary value.
//
// One learns: the whole way of the paper. A weight at P is moved about in a satellite of attitude a, mass and inertia
// one; nothing turns the two together, P x dP + da = 0. Where a step from (P0, a0) to (P1, a1) begins does not matter:
// what counts is the move d = P1 - P0 and j = P0 x P1 + a1 - a0. These (d, j) are a groupoid over one point,
//
//     (d, j)(d', j') = (d + d', j + j' - d x d'),    j = 0 along a step         [G] Def. 4.1, Example 4.3
//
// `reduce` makes the system on (d, j) of that on pairs. At least cost ([G] section 5): all as it was, the satellite
// turned by a right angle. The weight goes round a regular polygon; lifted, it moves in space ([G] Corollary 4.6).
//
// Run: ninja -C build/release 10_satellite && build/release/bin/10_satellite
#include <lagroid/core/reduction/descent.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

using namespace lagroid;

struct Turns : LieGroupoid<Turns, 3> {
  template <class S> using Arrow = Vector<S, 3>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Object<S> source(const Arrow<S>&) { return {}; }
  template <class S> static Object<S> target(const Arrow<S>&) { return {}; }
  template <class S> static Arrow<S> unit(const Object<S>&) { return Arrow<S>::Constant(S(0)); }
  template <class S> static Arrow<S> inverse(const Arrow<S>& g) { return -g; }
  template <class S> static Arrow<S> multiply(const Arrow<S>& g, const Arrow<S>& h) {
    return {g(0) + h(0), g(1) + h(1), g(2) + h(2) - g(0) * h(1) + g(1) * h(0)};
  }
  template <class S> static Arrow<S> tau(const Object<S>&, const Vector<S, 3>& v) { return v; }
  template <class S> static Vector<S, 3> tau_inverse(const Arrow<S>& g) { return g; }
  static std::string name() { return "turns by a weight"; }
};
struct Satellite : System<Satellite, PairOf<Turns>, /*arrow constraints*/ 1> {
  double h = 0.05;
  template <class S> S lagrangian(const ElementPair<Vector<S, 3>>& g) const {
    return (g.target - g.source).template head<2>().squaredNorm() * (0.5 / h);
  }
  template <class S> Vector<S, 1> constraint(const ElementPair<Vector<S, 3>>& g) const {
    return Vector<S, 1>(g.source(0) * g.target(1) - g.source(1) * g.target(0) + g.target(2) - g.source(2));
  }
};

int main() {
  const Satellite full;
  auto reduced = reduce(LeftQuotient<Turns>{}, full, arrows_about(full.groupoid, {0, 0, 0}));
  const double angle = std::numbers::pi / 2;
  const BoundaryProblem<decltype(reduced)> problem{reduced, {0, 0, angle}};
  const auto found = solve_boundary(*make_boundary_solver<decltype(reduced)>(), problem, /*steps=*/20).solutions;
  if (found.empty()) return 1;
  fmt::print("cost {:.4f}, of a polygon {:.4f}\n", found[0].cost, angle * std::tan(angle / 10) / full.h);
  Vector<double, 3> q(1, 0, 0);
  for (const auto& step : found[0].path) q = reduced.morphism.lift(q, step.arrow).target;
  fmt::print("from (1, 0, 0) to ({:.3f}, {:.3f}, {:.3f})\n", q(0), q(1), q(2));
}
