// Damping and step control of the iteration, and what is not a number.
#include "examples.hpp"

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lagroid::lie_newton_tests::iteration_tests {
namespace {

TEST(LieNewton, DampingLowersTheResidualOrRefuses) {
  int helped = 0;
  int refused = 0;
  for (const auto iteration : {LieIteration::version1, LieIteration::version2})
    for (Eigen::Index n = 3; n <= 6; ++n)
      for (int log2h = 0; log2h <= 6; ++log2h) {
        const Step step = example(NewtonExample::first, n, 1, std::ldexp(1.0, log2h));
        LieNewtonOptions options;
        options.iteration = iteration;
        options.tolerance = 1e-13 * (1 + step.step());
        const bool plain = lie_newton(step, zero(step), options).converged();
        options.halvings = 10;
        const auto damped = record(step, zero(step), options);
        for (std::size_t k = 0; k + 1 < damped.residuals.size(); ++k)
          EXPECT_LT(damped.residuals[k + 1], damped.residuals[k]);
        EXPECT_TRUE(damped.converged() || damped.iterations < 100) << "it goes on for nothing";
        helped += !plain && damped.converged() && iteration == LieIteration::version2;
        refused += damped.status == SolveStatus::stagnated;
      }
  EXPECT_GT(helped, 0);
  EXPECT_GT(refused, 0);
}

TEST(LieNewton, StepControlShortensUpdates) {
  const Step step = example(NewtonExample::first, 4, 1, 0.8);
  LieNewtonOptions options;
  options.iteration = LieIteration::version2;
  options.longest_update = 0.05;
  for (int limit = 1; limit <= 3; ++limit) {
    options.max_iterations = limit;
    EXPECT_LE(step.norm(lie_newton(step, zero(step), options).v), 0.05 * limit * (1 + 1e-12));
  }
  options.max_iterations = 100;
  EXPECT_TRUE(lie_newton(step, zero(step), options).converged());
}

TEST(LieNewton, WhatIsNotANumberNeverConverges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool everywhere : {true, false}) {
    const RotationFibre fibre(random_orthogonal(4, 1));
    const auto g = [&](const auto& y) {
      using S = typename std::decay_t<decltype(y)>::Scalar;
      Eigen::VectorX<S> out = Eigen::VectorX<S>::Zero(6);
      out(0) = y(0, 0) * 0.1;
      if (everywhere || value_of(y(0, 1)) != fibre.centre()(0, 1)) out(1) = S(nan);
      return out;
    };
    const ImplicitStep step{fibre, AutomaticField(fibre, g), 0.1};
    for (const auto iteration :
         {LieIteration::version1, LieIteration::version1_by_chart, LieIteration::version2, LieIteration::fixed_point})
      for (const int halvings : {0, 5}) {
        LieNewtonOptions options;
        options.iteration = iteration;
        options.halvings = halvings;
        EXPECT_FALSE(lie_newton(step, Eigen::VectorXd::Zero(6), options).converged());
      }
    EXPECT_FALSE(solve_by_ceres(step, Eigen::VectorXd::Zero(6)).converged());
    EXPECT_FALSE(solve_implicit_step(step).converged());
    LieIntegrator integrator(CrouchGrossman::dirk2(), fibre, step.field());
    EXPECT_FALSE(integrator.advance(0.1).converged());
    EXPECT_EQ(integrator.y(), fibre.centre());
  }
  const Step step = example(NewtonExample::first, 4, 1, nan);
  EXPECT_EQ(lie_newton(step, zero(step)).status, SolveStatus::not_finite);
  EXPECT_EQ(solve_implicit_step(step).status, SolveStatus::not_finite);
  const Step finite = example(NewtonExample::first, 4, 1, 0.1);
  EXPECT_EQ(lie_newton(finite, Eigen::VectorXd::Constant(6, nan)).status, SolveStatus::not_finite);
  LieNewtonOptions unreachable;
  unreachable.tolerance = nan;
  EXPECT_FALSE(lie_newton(finite, zero(finite), unreachable).converged());
}

}  // namespace
}  // namespace lagroid::lie_newton_tests::iteration_tests
