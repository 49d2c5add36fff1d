// Implicit steps of any size by continuation.
#include <lagroid/groupoids/rotation_fibre.hpp>
#include <lagroid/solvers/arclength.hpp>
#include <lagroid/solvers/ceres_lie.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace lagroid;

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
  const Step step = example(NewtonExample::first, 8, 0, 16);
  for (const auto iteration : {LieIteration::version1, LieIteration::version2, LieIteration::fixed_point}) {
    LieNewtonOptions options;
    options.iteration = iteration;
    options.tolerance = 1e-13 * (1 + step.step());
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(step.fibre().dimension());
    EXPECT_FALSE(lie_newton(step, zero, options).converged());
  }
  EXPECT_TRUE(solve_along_path(step).converged());
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
