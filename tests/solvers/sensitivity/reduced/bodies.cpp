// Derivatives of reduced runs of a rolling ball and a top: by a morphism and on a level of the momentum.

#include "reduced_runs.hpp"

#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_reduced_bodies_tests {
namespace {

constexpr long steps = steps_of_reduced;

RunFrom<RollingBall> ball() {
  RollingBall system;
  system.h = 0.05;
  const auto start = system.rolling({0.6, 0.1}, {0.2, -0.1}, 0.3);
  return {system, start, system.groupoid.unit(start.object), all_parameters(system).names};
}

RunFrom<HeavyTop> top() {
  HeavyTop system;
  system.h = 0.05;
  RunFrom<HeavyTop> out{system, {{}, {0.3, 0.8, 0.4}}, {}, all_parameters(system).names};
  out.configuration = {SO3::exp(Vector<double, 3>(0.2, 0.3, 0.1)), Vector<double, 3>(0, 0, 1)};
  out.start.object = system.groupoid.target(out.configuration);
  return out;
}
TEST(ReducedBodies, HaveTheDerivativesThatDifferencesTendTo) {
  expect_exact_derivatives(ball(), reduced_by<0>(), steps);
  expect_exact_derivatives(top(), reduced_by<0>(), steps);
}

}  // namespace
}  // namespace lagroid::sensitivity_reduced_bodies_tests
