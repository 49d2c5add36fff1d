// How the cost of a stationary path depends on its ends and on the parameters.

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/sensitivity/boundary/cost_gradient.hpp>
#include <lagroid/systems/control/unicycle.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace lagroid::sensitivity_boundary_costs_tests {
namespace {

constexpr std::size_t steps = 20;

/// A boundary value, and the parameters by which its cost is differentiated.
template <class Sys> struct Subject {
  BoundaryProblem<Sys> problem;
  std::vector<std::string> names;
};

Subject<Kepler> lambert(double by) {
  Subject<Kepler> out{{Kepler(), {{1, 0.1 * by}, {-0.3, 0.8}}}, {"strength"}};
  out.problem.system.strength = 1 + 0.1 * by;
  out.problem.system.h = 2.0 / double(steps);
  return out;
}
Subject<RigidBody> turn(double by) {
  Subject<RigidBody> out{{RigidBody(), SO3::exp(Vector<double, 3>(1.0, 0.8 + 0.1 * by, -0.5))}, {"inertia"}};
  out.problem.system.inertia(1) += 0.2 * by;
  out.problem.system.h = 2.0 / double(steps);
  return out;
}
/// Of optimal control, with constraints.
Subject<Unicycle> steering(double by) {
  const Unicycle system;
  const Vector<double, 3> end(1.0, 1.2, 0.5 + 0.1 * by);
  Subject<Unicycle> out{{system, system.groupoid.tau(Vector<double, 0>(), end)}, {"speed"}};
  out.problem.system.speed = 1 + 0.05 * by;
  out.problem.system.h = 2.0 / double(steps);
  return out;
}

template <class Sys> Path<Sys> solved(const BoundaryProblem<Sys>& problem, const Path<Sys>* guess = nullptr) {
  const auto solver = make_boundary_solver<Sys>();
  if (guess == nullptr) {
    const auto found = solve_boundary(*solver, problem, steps, {.starts = 10, .threads = 1});
    EXPECT_FALSE(found.solutions.empty());
    return found.solutions.empty() ? Path<Sys>() : found.solutions.front().path;
  }
  const auto solution = solver->solve(problem, *guess, false);
  EXPECT_TRUE(solution.converged());
  return solution.path;
}

/// The path with its product moved: tau(v)^{-1} g tau(w) beside it.
template <class Sys>
Path<Sys> with_ends(const Sys& system, Path<Sys> path, const Vector<double, Sys::dimension>& v,
                    const Vector<double, Sys::dimension>& w) {
  const auto& groupoid = system.groupoid;
  const Vector<double, Sys::dimension> zero = Vector<double, Sys::dimension>::Zero();
  path.front().arrow = groupoid.translate(v, path.front().arrow, zero);
  path.back().arrow = groupoid.translate(zero, path.back().arrow, w);
  return path;
}

/// Of all that the cost depends on, (v, w, parameters), each beside the extrapolated differences of solved problems.
template <class Sys> void expect_differences(const Subject<Sys>& subject) {
  constexpr int n = Sys::dimension;
  const BoundaryProblem<Sys>& problem = subject.problem;
  const Path<Sys> path = solved(problem);
  ASSERT_EQ(path.size(), steps);
  const CostGradient found = cost_gradient(problem.system, path, subject.names);
  Eigen::RowVectorXd exact(2 * n + int(found.parameters.size()));
  exact << found.by_start, found.by_end, found.by_parameters;
  for (int which = 0; which < exact.size(); ++which) {
    const auto cost = [&](double by) {
      BoundaryProblem<Sys> moved = problem;
      Vector<double, n> v = Vector<double, n>::Zero();
      Vector<double, n> w = Vector<double, n>::Zero();
      if (which < 2 * n) {
        (which < n ? v(which) : w(which - n)) = by;
      } else {
        const ParameterPlaces places = places_of_parameters(moved.system, subject.names);
        const_cast<double&>(*places.members[std::size_t(which - 2 * n)]) += by;
      }
      moved.boundary = problem.system.groupoid.translate(v, problem.boundary, w);
      const Path<Sys> guess = with_ends<Sys>(problem.system, path, v, w);
      return action(moved.system, solved(moved, &guess));
    };
    const auto central = [&](double width) { return (cost(width) - cost(-width)) / (2 * width); };
    const double a = central(4e-3);
    const double b = central(2e-3);
    const double c = central(1e-3);
    const double fine = (4 * c - b) / 3;
    const double difference = fine + (fine - (4 * b - a) / 3) / 15;
    EXPECT_NEAR(exact(which), difference, 1e-8 * std::max(1.0, std::abs(difference))) << which;
  }
}

TEST(CostGradients, AreWhatDifferencesOfSolvedProblemsTendTo) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 2; ++trial) {
    const double by = draw(random);
    expect_differences(lambert(by));
    expect_differences(turn(by));
    expect_differences(steering(by));
  }
}

/// Without its multipliers the path's sum misses what the constraints cost.
TEST(CostGradients, WithoutMultipliersMissTheDifferences) {
  const Subject<Unicycle> subject = steering(0);
  Path<Unicycle> path = solved(subject.problem);
  const CostGradient right = cost_gradient(subject.problem.system, path, subject.names);
  for (auto& step : path) step.multipliers.setZero();
  const CostGradient wrong = cost_gradient(subject.problem.system, path, subject.names);
  EXPECT_EQ(wrong.cost, right.cost);
  EXPECT_EQ(wrong.by_parameters(0), 0);
  EXPECT_GT(std::abs(right.by_parameters(0)), 1e-2);
}

TEST(CostGradients, RefuseWhatHasNone) {
  const Subject<Kepler> subject = lambert(0);
  EXPECT_THROW(cost_gradient(subject.problem.system, solved(subject.problem), {"weight"}), std::invalid_argument);
  EXPECT_THROW(cost_gradient(subject.problem.system, Path<Kepler>()), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::sensitivity_boundary_costs_tests
