// Inner nodes beside arrows of groups and action groupoids: their order, and the step without them.
#include <lagroid/systems/reference.hpp>

#include "same_step.hpp"
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

/// w = M, M' = -p2, p1' = w p2, p2' = -w p1.
TEST(AnyLagrangian, OrderSixOfEulersElastica) {
  const Vector<double, 3> mu(0.5, 1.2, -0.7);
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy << -y(2), y(0) * y(2), -y(0) * y(1); };
  const Eigen::VectorXd end = integrate_reference(rates, mu, 3.0);
  using Six = GalerkinOnNodes<Elastica, 3>;
  expect_order_on_nodes(Case<Six>{Six{}, Six::extended({{}, mu}), 3, end}, 8, 0.1);
}

TEST(AnyLagrangian, InnerNodesOfATopInsideOrBesideTheArrowGiveOneStep) {
  expect_same_step<Top, 2>({{0, 0.6, 0.8}, {0.4, 0.2, 1.5}}, 0.2, 20);
}

}  // namespace
