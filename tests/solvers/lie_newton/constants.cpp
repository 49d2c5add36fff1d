// The constants of Theorems 4.4 and 4.6, beside what iterations show.
#include "examples.hpp"

#include <lagroid/solvers/newton/convergence_constants.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

namespace lagroid::lie_newton_tests::constants_tests {
namespace {

/// Starts at a distance from the solution, on the group or in coordinates, in random directions.
class Around {
 public:
  Around(const Step& step, LieIteration iteration) : step_(step), iteration_(iteration) {
    LieNewtonOptions options;
    options.iteration = iteration;
    solution_ = lie_newton(step, zero(step), options);
    EXPECT_TRUE(solution_.converged());
    constants_ = convergence_constants(step, solution_, iteration);
  }
  const ConvergenceConstants& constants() const { return constants_; }

  /// From that far, after so many iterations: how far it is then; infinite where an iteration failed.
  double distance_after(double distance, int iterations) {
    Eigen::VectorXd u(solution_.v.size());
    for (double& each : u) each = normal_(bits_);
    u *= distance / u.norm();
    const bool on_the_group = iteration_ == LieIteration::version1;
    const auto start = on_the_group ? step_.fibre().coordinates(step_.fibre().moved(solution_.y, u))
                                    : std::optional<Eigen::VectorXd>(solution_.v + u);
    if (!start) return INFINITY;
    LieNewtonOptions options;
    options.iteration = iteration_;
    options.max_iterations = iterations;
    options.tolerance = 0;
    const auto after = lie_newton(step_, *start, options);
    if (after.status != SolveStatus::not_converged && !after.converged()) return INFINITY;
    if (!on_the_group) return (after.v - solution_.v).norm();
    const auto left = RotationFibre(solution_.y).coordinates(after.y);
    return left ? left->norm() : INFINITY;
  }

 private:
  Step step_;
  LieIteration iteration_;
  LieNewtonResult<Step::Fibre> solution_;
  ConvergenceConstants constants_{};
  std::mt19937_64 bits_{7};
  std::normal_distribution<double> normal_;
};

TEST(LieNewton, ConstantsOfTheTheoremsBoundWhatIterationsShow) {
  for (const auto which : {NewtonExample::first, NewtonExample::second})
    for (const LieIteration iteration : {LieIteration::version1, LieIteration::version2})
      for (const Eigen::Index n : {3, 4}) {
        Around around(example(which, n, 3, 0.2), iteration);
        const double bound = around.constants().eta * around.constants().gamma;
        ASSERT_TRUE(std::isfinite(bound));
        double largest = 0;
        const double distance = 1e-3 * around.constants().radius();
        for (int sample = 0; sample < 200; ++sample)
          largest = std::max(largest, around.distance_after(distance, 1) / (distance * distance));
        EXPECT_LE(largest, 1.01 * bound);
        EXPECT_GE(largest, 0.02 * bound);  // and are of its size
        // The basin that they predict is one: of a tenth less nothing is lost, and far beyond it something may be.
        for (int sample = 0; sample < 100; ++sample)
          EXPECT_LT(around.distance_after(0.9 * around.constants().radius(), 12), 1e-10) << sample;
        double observed = around.constants().radius();
        for (double factor = 1; factor < 40; factor *= 1.3) {
          bool all = true;
          for (int sample = 0; sample < 20 && all; ++sample)
            all = around.distance_after(factor * around.constants().radius(), 20) < 1e-10;
          if (!all) break;
          observed = factor * around.constants().radius();
        }
        std::cout << "  O(" << n << "), example " << (which == NewtonExample::first ? 1 : 2) << ", version "
                  << (iteration == LieIteration::version1 ? 1 : 2) << ": eta gamma " << bound << ", seen " << largest
                  << "; radius " << around.constants().radius() << ", all converged from " << observed << '\n';
      }
}

}  // namespace
}  // namespace lagroid::lie_newton_tests::constants_tests
