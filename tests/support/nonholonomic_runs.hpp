#pragma once
/// Long runs of the nonholonomic systems, of as many steps as a test has time for.

#include "run_watch.hpp"

#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace lagroid {

/// The largest |phi| over a run, over the size of its terms.
template <class Sys> Quantity<Sys> residual_quantity(const Sys& system) {
  return {"residual", {"phi"}, Promise::bounded, true, [system](const TrajectoryPoint<Sys>& p, double* out) {
            const auto d = two_sided(system, p.step.arrow, p.step.multipliers);
            const auto scale = system.groupoid.coordinate_scale(p.step.arrow);
            // One more than it is: `watch` divides by the first value.
            *out = 1 + d.constraint.cwiseAbs().maxCoeff() / (d.constraint_target.cwiseAbs() * scale).maxCoeff();
          }};
}

/// Constraints to round-off, no drift of energy, momenta and momentum equations to a random walk of round-off.
inline void expect_no_drift(long steps, double tolerance) {
  RollingBall ball;
  ball.plate_rate = 1.3;
  const auto rolling = watch(ball, ball.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7), steps, {residual_quantity(ball)});
  ASSERT_FALSE(rolling.empty());
  for (const char* name : {"K1", "K2", "K3 = k m r^2 w3", "moving energy E - Omega J"})
    EXPECT_LT(rolling.at(name).drift, tolerance) << name;
  EXPECT_LT(rolling.at("residual").drift, 1e-14);

  RollingDisk disk;
  const auto circle = watch(disk, disk.rolling(0.6, 1.1), steps, {residual_quantity(disk)});
  ASSERT_FALSE(circle.empty());
  for (const char* name : {"energy", "momentum equation of turning", "momentum equation of rolling"})
    EXPECT_LT(circle.at(name).drift, tolerance) << name;
  EXPECT_LT(circle.at("residual").drift, 1e-14);

  ChaplyginSleigh sleigh;
  sleigh.h = 0.05;
  const auto sliding = watch(sleigh, sleigh.sliding(1.0, -0.6), steps, {residual_quantity(sleigh)});
  ASSERT_FALSE(sliding.empty());
  for (const char* name : {"momentum equation of turning", "momentum equation of moving ahead"})
    EXPECT_LT(sliding.at(name).drift, tolerance) << name;
  EXPECT_LT(sliding.at("energy").last_quarter, 1.01 * sliding.at("energy").first_quarter);
  EXPECT_LT(sliding.at("energy").drift, 1e-3);
  EXPECT_LT(sliding.at("residual").drift, 1e-14);
}

}  // namespace lagroid
