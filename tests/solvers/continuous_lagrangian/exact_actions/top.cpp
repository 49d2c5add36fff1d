// Steps by the exact discrete Lagrangian are the flow of a heavy top.
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>

#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

TEST(ExactAction, StepsOfAHeavyTopAreItsFlow) {
  const State<Top::GroupoidType> start{{0, 0.6, 0.8}, {0.4, 0.2, 1.5}};
  const Top top;
  // M' = M x w + v x weight, v' = v x w.
  const auto rates = [&](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const Vector<double, 3> v = y.head<3>();
    const Vector<double, 3> momentum = y.tail<3>();
    const Vector<double, 3> w = momentum.cwiseQuotient(top.inertia);
    dy.head<3>() = v.cross(w);
    dy.tail<3>() = momentum.cross(w) + v.cross(top.weight);
  };
  Eigen::VectorXd y(6);
  y << start.object, start.momentum;
  expect_flow(ExactLagrangian<Top>{}, start, integrate_reference(rates, y, 2.0), 2, {10, 25});
}

}  // namespace
