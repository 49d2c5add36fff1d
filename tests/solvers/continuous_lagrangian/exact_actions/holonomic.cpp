// The exact discrete Lagrangian of a holonomic motion: its step is the flow on the constrained space.
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>

#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_holonomic_tests {
namespace {

TEST(ExactAction, StepsOfABeadOnASphereAreItsFlow) {
  expect_flow(ExactLagrangian<Bead>{}, bead_start, bead_end(4), 4, {10, 25});
}

}  // namespace
}  // namespace exact_actions_holonomic_tests
