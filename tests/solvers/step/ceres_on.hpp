#pragma once
// Two thousand steps by Ceres of a motion on a groupoid.
#include <lagroid/solvers/step/step_methods.hpp>
#include <lagroid/solvers/testing/solver_laws.hpp>

#include "groupoid_motion.hpp"

#include <gtest/gtest.h>

namespace lagroid {

/// From objects near one that no action leaves where it is.
template <class G> void expect_ceres_to_solve_as_newton(const ObjectOf<G>& near) {
  const Motion<G> system;
  const auto report = laws::solver_laws(
      system, [&] { return draw_motion(system.groupoid, near, 0.5); }, StepMethod::ceres);
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace lagroid
