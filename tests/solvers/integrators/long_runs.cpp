// A hundred thousand steps: momentum drift at round-off.
#include "../../support/nonholonomic_runs.hpp"
#include "../../support/run_watch.hpp"

#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace lagroid;

namespace integrators_long_runs_tests {
namespace {

class PlateBallLong : public ::testing::TestWithParam<RotationForm> {};

TEST_P(PlateBallLong, MomentaOverAHundredThousandSteps) {
  PlateBall system;
  system.h = 0.05;
  system.spin = 0.4;
  system.rotation = GetParam();
  State<PlateBall::GroupoidType> state;
  std::get<0>(state.object) << 0.3, -0.2;
  state.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  const auto seen = watch(system, state, 100'000);
  ASSERT_FALSE(seen.empty());
  EXPECT_LT(seen.at("spatial momentum A M").drift, 1e-12);
  EXPECT_LT(seen.at("J = x py - y px - M3").drift, 1e-11);
  EXPECT_EQ(seen.at("translational momentum").drift, 0) << "px and py are kept to the last bit";
  const auto& energy = seen.at("energy");
  EXPECT_LT(energy.last_quarter, 1.2 * energy.first_quarter) << "no energy drift";
}

INSTANTIATE_TEST_SUITE_P(Forms, PlateBallLong,
                         ::testing::Values(RotationForm::trace, RotationForm::exponential, RotationForm::cayley));

TEST(RigidBodyLong, MomentumOverAHundredThousandSteps) {
  RigidBody system;
  system.h = 0.05;
  State<SO3> state;
  state.momentum << 0.3, 1.5, 0.4;
  const auto seen = watch(system, state, 100'000);
  ASSERT_FALSE(seen.empty());
  EXPECT_LT(seen.at("spatial momentum A M").drift, 1e-12);
  EXPECT_LT(seen.at("energy").last_quarter, 1.1 * seen.at("energy").first_quarter);
}

TEST(RigidBodyLong, MomentumAndEnergyHaveNoTrendOverAMillionSteps) {
  RigidBody system;
  system.h = 0.05;
  system.rotation = RotationMap::cayley;
  State<SO3> state;
  state.momentum << 1.2, 0.1, 0.9;
  const long steps = 1'000'000;
  using Point = TrajectoryPoint<RigidBody>;
  const auto seen =
      watch(system, state, steps, {{"Casimir", {"|M|"}, Promise::conserved, false, [](const Point& p, double* out) {
                                      *out = p.state.momentum.norm();
                                    }}});
  ASSERT_FALSE(seen.empty());
  const auto& momentum = seen.at("spatial momentum A M");
  EXPECT_LT(momentum.drift, 2e-12);
  // A random walk of round-off has trends of this order; one unit in the last place a step would be fifty times as
  // much.
  EXPECT_LT(momentum.trend, 20 * std::numeric_limits<double>::epsilon() * std::sqrt(double(steps)));
  EXPECT_LT(seen.at("Casimir").drift, 1e-11);
  const auto& energy = seen.at("energy");
  EXPECT_LT(energy.trend, 1e-3 * energy.drift);
}

TEST(NonholonomicLong, EnergyAndMomentumOverAHundredThousandSteps) { expect_no_drift(100'000, 1e-12); }

}  // namespace
}  // namespace integrators_long_runs_tests
