// Velocity, momentum and arrow as independent variables: of regular Lagrangians the step is the rule's.
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/galerkin/hamilton_pontryagin.hpp>

#include "one_step.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace hamilton_pontryagin_regular_tests {
namespace {

TEST(HamiltonPontryagin, IsDiscreteEulerLagrangeOfRegularLagrangians) {
  expect_step_of<Midpoint<Orbit>>({{1, 0}, {0.1, 1.1}}, 0.05, 200);
  expect_step_of<Trapezoidal<Orbit>>({{1, 0}, {0.1, 1.1}}, 0.05, 200);
  expect_step_of<Midpoint<FreeBody<SO3>>>({{}, {0.3, 1.5, 0.4}}, 0.1, 100);
  expect_step_of<Midpoint<FreeBody<SpecialOrthogonal3<Retraction::cayley>>>>({{}, {0.3, 1.5, 0.4}}, 0.1, 100);
}
TEST(HamiltonPontryagin, VelocitiesAndMomentaAreThoseOfTheLegendreTransform) {
  using Sys = HamiltonPontryagin<Midpoint<Orbit>>;
  const Sys system{{}, 0.1};
  const State<Pair<2>> start{{1, 0}, {0.1, 1.1}};
  const auto from = Sys::extended(start);
  StepSolution<Sys> step;
  step.step = system.first_guess(from);
  ASSERT_EQ(NewtonStep<Sys>().solve(system, from, step).status, SolveStatus::converged);
  const auto& [arrow, beside] = step.step.arrow;
  EXPECT_LT((beside.head<2>() - (arrow.target - arrow.source) / 0.1).norm(), 1e-13);
  EXPECT_LT((beside.tail<2>() - beside.head<2>()).norm(), 1e-13);  // of unit mass
}

}  // namespace
}  // namespace hamilton_pontryagin_regular_tests
