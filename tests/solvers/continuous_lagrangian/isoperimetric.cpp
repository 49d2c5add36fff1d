// A constraint that cannot be integrated, at every point of a curve: orders and multipliers.
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_isoperimetric_tests {
namespace {

const State<Pair<3>> area_start{{0.8, -0.3, 0.1}, {0.5, 0.9, 1.3}};

/// mu = dl + lambda dpsi: p_x = x' + lambda y / 2, p_y = y' - lambda x / 2, p_z = lambda.
Eigen::VectorXd area_end(double t) {
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const double lambda = y(5);
    const double u = y(3) - lambda * y(1) / 2;
    const double v = y(4) + lambda * y(0) / 2;
    dy << u, v, (y(0) * v - y(1) * u) / 2, -y(0) / 2 - 0.4 * y(0) * y(1) * y(1) - lambda * v / 2,
        -2 * y(1) / 3 - 0.4 * y(0) * y(0) * y(1) + lambda * u / 2, 0;
  };
  Eigen::VectorXd y(6);
  y << area_start.object, area_start.momentum;
  return integrate_reference(rates, y, t);
}
template <class Sys> Case<Sys> area() { return {Sys{}, Sys::extended(area_start), 3, area_end(3)}; }

TEST(AnyLagrangian, OrdersWithAConstraintThatCannotBeIntegrated) {
  expect_order(Case<Midpoint<Area>>{Midpoint<Area>{}, area_start, 3, area_end(3)}, 40);
  expect_order(Case<Trapezoidal<Area>>{Trapezoidal<Area>{}, area_start, 3, area_end(3)}, 40);
  expect_order_on_nodes(area<GalerkinOnNodes<Area, 2>>(), 15, 0.1);
  expect_order_on_nodes(area<GalerkinOnNodes<Area, 3>>(), 9, 0.1);
}

// p_z does not change and is every multiplier; psi is zero at every point of the curve, and the nodes' momenta stay
// zero.
TEST(AnyLagrangian, ConstraintsHoldAtEveryPointAndMultipliersAreThoseOfTheProblem) {
  using Sys = GalerkinOnNodes<Area, 3>;
  const Sys system{Area{}, 0.05};
  auto run = make(system, Sys::extended(area_start));
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& p = run.point();
    EXPECT_EQ(p.state.momentum.tail<6>().norm(), 0);
    EXPECT_NEAR(p.state.momentum(2), 1.3, 1e-13);
    for (double lambda : p.step.multipliers) EXPECT_NEAR(lambda, 1.3, 1e-10);
    EXPECT_LT(system.constraint(p.step.arrow).norm() / system.h, 1e-13);
  }
}

}  // namespace
}  // namespace continuous_lagrangian_isoperimetric_tests
