// Boundary values of any system: work linear in N, stationary points, object constraints, continuation.
#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include "../boundary_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

using namespace lagroid;

namespace boundary_values_paths_tests {
namespace {

TEST(Work, IterationsDoNotGrowWithTheNumberOfArrows) {
  // From the straight line, to 1e-10.
  int first = 0;
  for (const std::size_t steps : {100U, 1000U, 10000U}) {
    const PlateBall system = plate_ball(steps);
    const auto solution =
        make_boundary_solver<PlateBall>()->solve({system, plate_ball_ends()}, straight(system, steps), false);
    ASSERT_TRUE(solution.converged()) << steps;
    EXPECT_LE(solution.residual, 1e-10);
    EXPECT_TRUE(solution.kind.is_minimum);
    if (steps == 100) first = solution.iterations;
    EXPECT_LE(solution.iterations, first + 3);
  }
}

/// Counts what a solve asks of the system.
struct Counted : Kepler {
  static inline long lagrangians = 0;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    ++lagrangians;
    return Kepler::lagrangian(g);
  }
};

TEST(Work, EvaluationsPerArrowDoNotGrowWithTheNumberOfArrows) {
  double first = 0;
  for (const std::size_t steps : {100U, 1000U, 10000U}) {
    Counted system;
    system.h = 2 / double(steps);
    const BoundaryProblem<Counted> problem{system, {{1, 0}, {-0.3, 0.8}}};
    Counted::lagrangians = 0;
    const auto solution = BoundaryNewton<Counted>().solve(problem, geodesic_path(problem, steps), false);
    ASSERT_TRUE(solution.converged()) << steps;
    EXPECT_LE(solution.residual, 1e-10);
    const double each = double(Counted::lagrangians) / double(steps);
    if (steps == 100) first = each;
    EXPECT_GT(each, 1) << "they are counted";
    EXPECT_LE(each, 1.3 * first);
  }
}

TEST(Work, AWarmStartTakesAFewIterationsWhateverN) {
  for (const std::size_t steps : {100U, 1000U, 10000U}) {
    PlateBall system = plate_ball(steps);
    const BoundaryProblem<PlateBall> problem{system, plate_ball_ends()};
    const auto first = make_boundary_solver<PlateBall>()->solve(problem, straight(system, steps), false);
    system.plate_rate = 1.01;
    const auto next = make_boundary_solver<PlateBall>()->solve({system, plate_ball_ends()}, first.path, true);
    ASSERT_TRUE(next.converged());
    EXPECT_LE(next.iterations, 6) << steps;
  }
}

TEST(Stationary, MotionsPastAConjugatePointAreFoundAndNamed) {
  // A pendulum near its equilibrium swings back after half a period: past that the action is no longer least.
  Pendulum system = pendulum();
  const std::size_t steps = 90;  // 4.5 s; the first conjugate point lies near pi
  const auto k = known(system, {Vector<double, 1>(0.05), Vector<double, 1>(0.1)}, steps);
  const auto stationary = make_boundary_solver<Pendulum>();
  EXPECT_EQ(stationary->stationary_kind(), StationaryKind::stationary);
  const auto found = stationary->solve(k.problem, geodesic_path(k.problem, steps), false);
  ASSERT_TRUE(found.converged());
  EXPECT_NEAR(found.cost, action(system, k.path), 1e-12);
  EXPECT_FALSE(found.kind.is_minimum);
  EXPECT_EQ(found.kind.negative_directions, 1);
}

TEST(Stationary, PathsStayOnTheObjectConstraint) {
  const SphericalPendulum system = spherical_pendulum();
  const auto k = known(system, {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 40);
  const auto found = make_boundary_solver<SphericalPendulum>()->solve(k.problem, geodesic_path(k.problem, 40), false);
  ASSERT_TRUE(found.converged());
  for (std::size_t i = 1; i < found.path.size(); ++i) {
    EXPECT_NEAR(found.path[i].multipliers(0), k.path[i].multipliers(0), 1e-9) << i;
    EXPECT_LT(std::abs(system.object_constraint(found.path[i].arrow.target)(0)), 1e-12);
    EXPECT_LT((found.path[i].arrow.target - k.path[i].arrow.target).norm(), 1e-9) << i;
  }
}

TEST(Stationary, EndsOffTheConstraintAreRefused) {
  const BoundaryProblem<SphericalPendulum> problem{spherical_pendulum(), {{0.6, 0, -0.8}, {0, 1.1, 0}}};
  ASSERT_TRUE(inadmissible_ends(problem).has_value());
  EXPECT_THROW(solve_boundary(*make_boundary_solver<SphericalPendulum>(), problem, 20), std::invalid_argument);
}

TEST(Stationary, OptionsOutOfRangeAreRefused) {
  const auto k = known(pendulum(), {Vector<double, 1>(0.1), Vector<double, 1>(0.1)}, 4);
  const auto solver = make_boundary_solver<Pendulum>();
  MultistartOptions options;
  options.coarse_steps = 0;
  EXPECT_THROW(solve_boundary(*solver, k.problem, 4, options), std::invalid_argument);
  options.coarse_steps = 1;
  EXPECT_THROW(solve_boundary(*solver, k.problem, 4, options), std::invalid_argument);
  options = {};
  options.starts = 0;
  EXPECT_THROW(solve_boundary(*solver, k.problem, 4, options), std::invalid_argument);
  options = {};
  for (const double amplitude : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    options.amplitude = amplitude;
    EXPECT_THROW(solve_boundary(*solver, k.problem, 4, options), std::invalid_argument) << amplitude;
  }
}

TEST(Continuation, CarriesASolutionAcrossAParameter) {
  const auto stage = [](double s) {
    PlateBall system = plate_ball(30);
    system.plate_rate = 3 * s;
    return BoundaryStage<PlateBall>{{system, plate_ball_ends()}, 30};
  };
  const auto solver = make_boundary_solver<PlateBall>();
  const auto start = solver->solve(stage(0).problem, straight(stage(0).problem.system, 30), false);
  ASSERT_TRUE(start.converged());
  const auto end = follow(*solver, stage, start);
  ASSERT_TRUE(end.converged());
  EXPECT_EQ(end.reached, 1);
  const auto again = solver->solve(stage(1).problem, end.solution.path, true);
  EXPECT_NEAR(again.cost, end.solution.cost, 1e-12 * again.cost);
  EXPECT_TRUE(end.solution.kind.is_minimum);
}

TEST(Continuation, MovesBothEndsAndChangesTheNumberOfArrows) {
  const auto k = known(kepler(), {{1, 0}, {0.1, 0.9}}, 80);
  const auto stage = [&](double s) {
    BoundaryStage<Kepler> out{k.problem, s < 0.5 ? std::size_t(80) : std::size_t(160)};
    out.problem.boundary.source += s * Vector<double, 2>(0.1, -0.2);
    out.problem.boundary.target += s * Vector<double, 2>(-0.3, 0.1);
    if (s >= 0.5) out.problem.system.h /= 2;
    return out;
  };
  const auto solver = make_boundary_solver<Kepler>();
  const auto end = follow(*solver, stage, solver->solve(k.problem, k.path, true));
  ASSERT_TRUE(end.converged());
  EXPECT_EQ(end.solution.path.size(), 160U);
  EXPECT_EQ(end.solution.path.front().arrow.source, stage(1).problem.boundary.source);
  EXPECT_LT(end.solution.residual, 1e-10);
}

TEST(Continuation, SaysHowFarItCameWhereSolutionsEnd) {
  // Steps of the trace form turn by less than pi/2, so |c h| < 1: beyond spin 30 nothing can roll there.
  const auto stage = [](double s) {
    PlateBall system = plate_ball(30);
    system.rotation = RotationForm::trace;
    system.spin = 60 * s;
    return BoundaryStage<PlateBall>{{system, plate_ball_ends()}, 30};
  };
  const auto solver = make_boundary_solver<PlateBall>();
  const auto start = solver->solve(stage(0).problem, straight(plate_ball(30), 30), false);
  ASSERT_TRUE(start.converged());
  HomotopyOptions options;
  options.smallest_step = 1e-2;
  const auto end = follow(*solver, stage, start, options);
  EXPECT_FALSE(end.converged());
  EXPECT_LT(end.reached, 0.5);
  EXPECT_GT(end.failures, 0);
  EXPECT_TRUE(end.solution.converged());
}

}  // namespace
}  // namespace boundary_values_paths_tests
