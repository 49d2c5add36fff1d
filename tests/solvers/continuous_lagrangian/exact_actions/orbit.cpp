// Steps by the exact discrete Lagrangian are the flow of Kepler's problem.
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>
#include <lagroid/systems/kepler.hpp>

#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_orbit_tests {
namespace {

TEST(ExactAction, StepsOfAnOrbitAreItsFlow) {
  const State<Pair<2>> start{{1, 0.1}, {0.1, 1.1}};
  const State<Pair<2>> end = Kepler{}.reference(start, 6.0);
  Eigen::VectorXd exact(4);
  exact << end.object, end.momentum;
  expect_flow(ExactLagrangian<Orbit>{}, start, exact, 6, {16, 40});
}

}  // namespace
}  // namespace exact_actions_orbit_tests
