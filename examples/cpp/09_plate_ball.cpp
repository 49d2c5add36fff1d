// 09  A boundary value: optimal control of a rolling ball.
//
// One learns: that control at least cost is the same mechanics, asked from end to end. A ball of radius one rolls on a
// table; it neither slips nor spins about the vertical, and its centre is led so that the sum of h |v|^2 / 2 is least.
// An arrow of R^2 x R^2 x SO(3) is where the centre went and how the ball turned meanwhile. Three constraints tie the
// two:
//
//     dy + w1 = 0,  dx - w2 = 0,  w3 = 0,    w = log(g)            [G] 6.2, (8) with a table at rest
//
// Given is the product of all arrows, that is both places and the turn in between ([G] section 5). Here: come back to
// where you started, with the ball turned about the vertical by a right angle, though it may never spin.
//
// Run: ninja -C build/release 09_plate_ball && build/release/bin/09_plate_ball
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include <fmt/format.h>

#include <numbers>
#include <tuple>

using namespace lagroid;
using G = Product<Pair<2>, SO3>;

struct RolledBall : System<RolledBall, G, /*arrow constraints*/ 3> {
  double h = 0.05;
  template <class S> static Vector<S, 2> move(const std::tuple<PairArrow<S, 2>, Matrix<S, 3, 3>>& g) {
    return std::get<0>(g).target - std::get<0>(g).source;
  }
  template <class S> S lagrangian(const std::tuple<PairArrow<S, 2>, Matrix<S, 3, 3>>& g) const {
    return move(g).squaredNorm() * (0.5 / h);
  }
  template <class S> Vector<S, 3> constraint(const std::tuple<PairArrow<S, 2>, Matrix<S, 3, 3>>& g) const {
    const Vector<S, 2> d = move(g);
    const Vector<S, 3> w = SO3::log(std::get<1>(g));
    return {d(1) + w(0), d(0) - w(1), w(2)};
  }
};

int main() {
  const Vector<double, 2> here(0, 0);
  const Matrix<double, 3, 3> quarter = SO3::exp(Vector<double, 3>(0, 0, std::numbers::pi / 2));
  const BoundaryProblem<RolledBall> problem{{}, {{here, here}, quarter}};
  const auto found = solve_boundary(*make_boundary_solver<RolledBall>(), problem, /*steps=*/20);
  if (found.solutions.empty()) return 1;
  const auto& best = found.solutions.front();
  double length = 0;
  for (const auto& step : best.path) length += RolledBall::move(step.arrow).norm();
  fmt::print("the cheapest way found costs {:.3f} and is {:.3f} long: {}\n", best.cost, length,
             best.kind.is_minimum ? "a minimum" : "no minimum");
  return 0;
}
