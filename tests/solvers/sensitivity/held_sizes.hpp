// The broken subject of derivatives of steps that vary.
#pragma once

#include <lagroid/solvers/sensitivity/linearised_step.hpp>

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace lagroid::sensitivity_tests {

/// The end of a run by its start (v, mu), the sizes of its steps taken for constants.
template <class Motion, class Sys> Eigen::MatrixXd end_of_sizes_held_fixed(Motion& motion, Sys system, long steps) {
  constexpr int n = Sys::dimension;
  Eigen::MatrixXd held = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (long k = 0; k < steps; ++k) {
    EXPECT_TRUE(motion.advance().converged());
    system.h = motion.point().step_size;
    LinearStep step(n, 2 * n, 0);
    linearise_step(system, motion.point().step, {}, step);
    EXPECT_TRUE(step.factor());
    held = step.forward(held);
  }
  return held;
}

}  // namespace lagroid::sensitivity_tests
