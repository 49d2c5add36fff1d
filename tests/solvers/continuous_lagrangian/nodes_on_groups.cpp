// Inner nodes beside arrows of groups and action groupoids: their order, and the step without them.
#include "same_step.hpp"
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_nodes_on_groups_tests {
namespace {

TEST(AnyLagrangian, OrderSixOfEulersElastica) {
  using Six = GalerkinOnNodes<Elastica, 3>;
  expect_order_on_nodes(Case<Six>{Six{}, Six::extended({{}, elastica_start}), 3, elastica_end(3)}, 8, 0.1);
}

TEST(AnyLagrangian, InnerNodesOfATopInsideOrBesideTheArrowGiveOneStep) {
  expect_same_step<Top, 2>({{0, 0.6, 0.8}, {0.4, 0.2, 1.5}}, 0.2, 20);
}

}  // namespace
}  // namespace continuous_lagrangian_nodes_on_groups_tests
