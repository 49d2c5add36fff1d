// The laws of exact derivatives with forces, and a step that is not symplectic.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_forced_tests {
namespace {

using laws::draw_uniform;

TEST(SensitivityLaws, HoldWithForces) {
  DampedPendulum damped;
  damped.h = 0.05;
  const auto draw = [] { return State<Pair<1>>{Vector<double, 1>(draw_uniform()), Vector<double, 1>(draw_uniform())}; };
  const auto forced = laws::sensitivity_laws(damped, draw);
  EXPECT_TRUE(forced.holds()) << forced;
}

/// Damping takes phase volume away: the matrix of a forced step is not symplectic.
TEST(SensitivityLaws, AForcedStepIsNotSymplectic) {
  DampedPendulum damped;
  damped.h = 0.05;
  damped.damping = 1;
  EXPECT_GT(laws::symplectic_defect(damped, {Vector<double, 1>(0.3), Vector<double, 1>(0.1)}, 5), 1e-2);
}

}  // namespace
}  // namespace lagroid::sensitivity_forced_tests
