// Velocity, momentum and arrow as independent variables on an action groupoid, and with constraints of velocities.
#include "one_step.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace hamilton_pontryagin_on_groupoids_tests {
namespace {

TEST(HamiltonPontryagin, IsDiscreteEulerLagrangeOnAnActionGroupoid) {
  expect_step_of<Trapezoidal<Top>>({{0, 0.6, 0.8}, {0.4, 0.2, 1.5}}, 0.05, 100);
}
TEST(HamiltonPontryagin, TakesConstraintsOfTheVelocity) {
  expect_step_of<Midpoint<Elastica>>({{}, elastica_start}, 0.05, 60);
}

}  // namespace
}  // namespace hamilton_pontryagin_on_groupoids_tests
