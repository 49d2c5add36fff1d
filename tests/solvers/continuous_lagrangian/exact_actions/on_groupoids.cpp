// Steps by the exact discrete Lagrangian are the flow on SO(3) and on an action groupoid.
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "../../../support/affine.hpp"
#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_on_groupoids_tests {
namespace {

TEST(ExactAction, StepsOfAFreeBodyAreItsFlow) {
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto none = [](const auto&, const auto&) { return Vector<double, 3>(0, 0, 0); };
  const Vector<double, 3> end = reference_turn({1, 2, 3}, none, start.momentum, attitude, 4.0);
  Eigen::VectorXd exact(12);
  exact << end, attitude.reshaped();
  expect_flow(ExactLagrangian<FreeBody<SO3>>{}, start, exact, 4, {6, 20});
}

/// A motion on a groupoid that is not of the library: xi of Aff(1), x moved by it.
struct Moved : ContinuousLagrangian<Affine> {
  template <class S> S l(const Vector<S, 1>& x, const Vector<S, 2>& xi) const {
    return (xi(0) * xi(0) + xi(0) * xi(1) * 0.4 + xi(1) * xi(1) * 1.5) * 0.5 - x(0) * x(0) * 0.5;
  }
};
// Of its retraction nothing is known, and it is not exponential to third order.
TEST(ExactAction, OrdersOnAGroupoidOfOnesOwn) {
  static_assert(retraction_kind_of<Affine>() == RetractionKind::any);

  const State<Affine> start{Vector<double, 1>(0.4), {0.6, -0.5}};
  const auto end_of = [&](int steps) {
    auto run = make(ExactLagrangian<Moved>{{}, 2.0 / steps}, start);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged()) << k;
    return Eigen::VectorXd(numbers(run.system(), run.point()).head<3>());
  };
  const Eigen::VectorXd end = end_of(8);
  EXPECT_LT((end_of(20) - end).norm(), 1e-12);
  expect_order(Case<Midpoint<Moved>>{Midpoint<Moved>{}, start, 2, end}, 40);
  expect_order(Case<Trapezoidal<Moved>>{Trapezoidal<Moved>{}, start, 2, end}, 40);
  expect_order(Case<Galerkin<Moved, 2>>{Galerkin<Moved, 2>{}, start, 2, end}, 10);
  expect_order(Case<Galerkin<Moved, 3>>{Galerkin<Moved, 3>{}, start, 2, end}, 6);
}

}  // namespace
}  // namespace exact_actions_on_groupoids_tests
