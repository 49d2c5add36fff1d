// Orders of the rules, measured, on the pair groupoid and on an action groupoid; on groups: orders_on_groups.cpp.
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_orders_tests {
namespace {

template <class Sys> Case<Sys> swing(double horizon = 10) {
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const State<Pair<1>> end = reference_motion(
      1.0, [](const auto& q, const auto&, double) { return Vector<double, 1>(-std::sin(q(0))); }, start, horizon);
  return {Sys{}, start, horizon, Eigen::Vector2d(end.object(0), end.momentum(0))};
}
TEST(AnyLagrangian, OrdersOnThePendulum) {
  expect_order(swing<Midpoint<Swing>>(), 60);
  expect_order(swing<Trapezoidal<Swing>>(), 60);
  expect_order(swing<Galerkin<Swing, 2>>(), 30);
  expect_order(swing<Galerkin<Swing, 3>>(), 20);
  expect_order(swing<Galerkin<Swing, 4>>(20), 33, 0.3);
}
TEST(AnyLagrangian, OrdersOnThePendulumByLobatto) {
  expect_order(swing<Galerkin<Swing, 2, CurveQuadrature::lobatto>>(), 30);
  expect_order(swing<Galerkin<Swing, 3, CurveQuadrature::lobatto>>(), 20);
  expect_order(swing<Galerkin<Swing, 4, CurveQuadrature::lobatto>>(40), 80, 0.3);
}
template <class Sys> Case<Sys> top() { return {Sys{}, {top_start.object, top_start.momentum}, 3, top_end(3.0)}; }
TEST(AnyLagrangian, OrdersOnTheHeavyTop) {
  expect_order(top<Midpoint<Top>>(), 40);
  expect_order(top<Trapezoidal<Top>>(), 40);
  expect_order(top<Galerkin<Top, 2>>(), 12);
  expect_order(top<Galerkin<Top, 3>>(), 8);
}

/// Declares what it does not have.
struct Boastful : Midpoint<Swing> {
  using Midpoint<Swing>::Midpoint;
  static MethodTraits traits() { return {"boastful", 4, true, true, false}; }
};
TEST(AnyLagrangian, AnOrderThatIsNotThereIsSeen) {
  const auto c = swing<Midpoint<Swing>>();
  laws::OrderProblem problem;
  problem.exact = c.exact;
  problem.coarsest = 60;
  problem.end = [&](int steps) {
    auto run = make(Midpoint<Swing>{{}, c.horizon / steps}, c.start);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
    return Eigen::VectorXd(numbers(c.system, run.point()).head(2));
  };
  const auto report = laws::order_laws(Boastful::traits(), problem);
  EXPECT_EQ(report.laws.front().name, "the error falls as declared");
  EXPECT_FALSE(report.holds());
}

}  // namespace
}  // namespace continuous_lagrangian_orders_tests
