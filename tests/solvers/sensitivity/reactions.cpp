// The laws of exact derivatives with nonholonomic constraints.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_reactions_tests {
namespace {

using laws::draw_uniform;

TEST(SensitivityLaws, HoldWithReactions) {
  RollingBall ball;
  ball.plate_rate = 0.7;
  const auto rolling = laws::sensitivity_laws(ball, [&] {
    return ball.rolling({draw_uniform(), draw_uniform()}, {draw_uniform(), draw_uniform()}, draw_uniform());
  });
  EXPECT_TRUE(rolling.holds()) << rolling;
}

}  // namespace
}  // namespace lagroid::sensitivity_reactions_tests
