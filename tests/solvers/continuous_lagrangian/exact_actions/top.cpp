// Steps by the exact discrete Lagrangian are the flow of a heavy top.
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>

#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_top_tests {
namespace {

TEST(ExactAction, StepsOfAHeavyTopAreItsFlow) {
  expect_flow(ExactLagrangian<Top>{}, top_start, top_end(2.0), 2, {10, 25});
}

}  // namespace
}  // namespace exact_actions_top_tests
