// Implicit steps of any size by continuation.
#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/step/arclength.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace lagroid;

namespace step_arclength_tests {
namespace {

using Step = ImplicitStep<RotationFibre<>, ExampleField<>>;

Step example(NewtonExample which, Eigen::Index n, std::uint64_t seed, double h) {
  return {RotationFibre(random_orthogonal(n, seed)), ExampleField(which), h};
}

TEST(Arclength, ReachesEveryStepSize) {
  int beyond = 0;
  for (const auto which : {NewtonExample::first, NewtonExample::second})
    for (const Eigen::Index n : {2, 3, 5, 7})
      for (int log2h = -10; log2h <= 10; ++log2h) {
        const Step step = example(which, n, 21, std::ldexp(1.0, log2h));
        const auto found = solve_implicit_step(step);
        ASSERT_TRUE(found.converged()) << n << ' ' << log2h << ' ' << to_string(found.status);
        EXPECT_LE(step.norm(step.residual(found.y, found.v)), 1e-13 * (1 + step.step()));
        EXPECT_LT((found.y.transpose() * found.y - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-13);
        beyond += step.norm(found.v) > std::numbers::pi;
      }
  EXPECT_GT(beyond, 0) << "some solutions lie where no logarithm finds them";
}

TEST(Arclength, SolvesWhatEveryIterationOfThePaperMisses) {
  int missed = 0;
  int steps = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    for (int log2h = 4; log2h <= 10; log2h += 2) {
      const Step step = example(NewtonExample::first, 10, seed, std::ldexp(1.0, log2h));
      const auto converges = [&](LieIteration iteration) {
        LieNewtonOptions options;
        options.iteration = iteration;
        options.tolerance = 1e-13 * (1 + step.step());
        return lie_newton(step, Eigen::VectorXd::Zero(step.fibre().dimension()), options).converged();
      };
      ++steps;
      missed += !converges(LieIteration::version1) && !converges(LieIteration::version2) &&
                !converges(LieIteration::fixed_point);
      EXPECT_TRUE(solve_along_path(step).converged()) << seed << ' ' << log2h;
    }
  EXPECT_GT(missed, steps / 2);
}

TEST(Arclength, InExtendedPrecisionToo) {
  const RotationFibre fibre(random_orthogonal<long double>(5, 2));
  const ExampleField<long double> field(NewtonExample::second);
  ArclengthOptions options;
  options.tolerance = 1e-16;
  const auto found = SolutionPath(fibre, field, options).reach(3);
  ASSERT_TRUE(found.converged()) << to_string(found.status);
  EXPECT_LT(found.residual, 4e-16);
  LieIntegrator integrator(CrouchGrossman::dirk3(), fibre, field, options);
  EXPECT_TRUE(integrator.advance(0.1).converged());
}

TEST(Arclength, AStepBehindThePathOrBelowRoundOffIsRefused) {
  const Step step = example(NewtonExample::first, 4, 1, 1);
  SolutionPath path(step.fibre(), step.field());
  EXPECT_TRUE(path.reach(2).converged());
  EXPECT_THROW(path.reach(1), std::invalid_argument);
  EXPECT_TRUE(path.reach(2).converged());
  ArclengthOptions exact;
  exact.tolerance = 0;
  const auto nearly = SolutionPath(step.fibre(), step.field(), exact).reach(2);
  EXPECT_EQ(nearly.status, SolveStatus::ill_conditioned);
  EXPECT_LT(nearly.residual, 1e-14);
  EXPECT_EQ(SolutionPath(step.fibre(), step.field()).reach(HUGE_VAL).status, SolveStatus::not_finite);
}

TEST(Arclength, CeresFindsTheSameSolutionsWhereItFindsOne) {
  int solved = 0;
  int missed = 0;
  for (const auto which : {NewtonExample::first, NewtonExample::second})
    for (const Eigen::Index n : {3, 5, 8})
      for (int log2h = -10; log2h <= 10; log2h += 2) {
        const Step step = example(which, n, 21, std::ldexp(1.0, log2h));
        LieNewtonOptions options;
        options.tolerance = 1e-13 * (1 + step.step());
        options.max_iterations = 500;
        const auto ceres = solve_by_ceres(step, Eigen::VectorXd::Zero(step.fibre().dimension()), options);
        if (!ceres.converged()) {
          ++missed;
          EXPECT_TRUE(ceres.status == SolveStatus::stagnated || ceres.status == SolveStatus::not_converged);
          continue;
        }
        ++solved;
        EXPECT_LE(step.norm(step.residual(ceres.y, ceres.v)), options.tolerance);
        if (log2h > -4) continue;  // for larger steps there are many solutions
        EXPECT_LT((ceres.y - solve_implicit_step(step).y).norm(), 1e-12);
      }
  EXPECT_GT(solved, 3 * missed);
}

TEST(Arclength, TheJumpBetweenStretchesThatItsOrientationTells) {
  // Correctors that land on another stretch of these paths contract well, but run away to infinity or through h = 0.
  for (const Step& step : {example(NewtonExample::first, 7, 19, 8), example(NewtonExample::first, 8, 5, 4),
                           example(NewtonExample::second, 10, 12, 16), example(NewtonExample::first, 4, 1, -20)})
    EXPECT_TRUE(solve_along_path(step).converged());
}

TEST(Arclength, FollowsThePathToNegativeSteps) {
  const auto found = solve_along_path(example(NewtonExample::first, 4, 1, -20));
  ASSERT_TRUE(found.converged());
  EXPECT_EQ(found.h, -20);
}

TEST(Arclength, OnePathServesManySteps) {
  const Step step = example(NewtonExample::second, 6, 2, 1);
  SolutionPath path(step.fibre(), step.field());
  for (int log2h = -10; log2h <= 10; ++log2h) {
    const Step at(step.fibre(), step.field(), std::ldexp(1.0, log2h));
    const auto found = path.reach(at.step());
    ASSERT_TRUE(found.converged()) << log2h;
    EXPECT_LE(at.norm(at.residual(found.y, found.v)), 1e-13 * (1 + at.step()));
    EXPECT_EQ(found.factorisations, solve_along_path(at).factorisations) << "what a path of its own costs";
  }
}

TEST(Arclength, SaysHowFarItCame) {
  ArclengthOptions few;
  few.max_steps = 5;
  const auto found = solve_along_path(example(NewtonExample::first, 4, 1, 100), few);
  EXPECT_EQ(found.status, SolveStatus::not_converged);
  EXPECT_EQ(found.steps, 5);
  EXPECT_GT(found.h, 0);
  EXPECT_LT(found.h, 100);
  EXPECT_LT(found.residual, 1e-10);
}

}  // namespace
}  // namespace step_arclength_tests
