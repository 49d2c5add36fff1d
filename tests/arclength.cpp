// Implicit steps of any size by continuation.
#include <lagroid/groupoids/rotation_fibre.hpp>
#include <lagroid/solvers/arclength.hpp>
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
