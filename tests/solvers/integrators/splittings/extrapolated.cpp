// Extrapolation of splitting steps: its tolerance, its rows side by side, what it costs, and why it stops.
#include <lagroid/solvers/extrapolation/extrapolated_splitting.hpp>
#include <lagroid/solvers/integrators/integrator_of.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "problems.hpp"

#include "../../../support/allocation_counter.hpp"

namespace lagroid::splitting_tests::extrapolated_tests {
namespace {

template <class Sys> ExtrapolatedSplitting<Sys> extrapolated(Problem<Sys> problem, double tolerance, int nodes = 1) {
  problem.system.h = problem.horizon / nodes;
  return {problem.system, problem.start, problem.system.groupoid.unit(problem.start.object), tolerance};
}

/// Where it ends, and how many Strang steps that takes.
template <class Sys> std::pair<double, long> run(const Problem<Sys>& problem, double tolerance, int nodes = 1) {
  auto integrator = extrapolated(problem, tolerance, nodes);
  long steps = 0;
  for (int i = 0; i < nodes; ++i) {
    const StepReport report = integrator.advance();
    EXPECT_TRUE(report.converged()) << to_string(report.status);
    steps += report.iterations;
  }
  EXPECT_DOUBLE_EQ(integrator.point().time, problem.horizon);
  return {problem.error(integrator.point()), steps};
}

template <class Sys> void follows_its_tolerance(const Problem<Sys>& problem) {
  double last = 1;
  for (const double tolerance : {1e-4, 1e-7, 1e-10, 1e-13}) {
    const auto [error, steps] = run(problem, tolerance);
    EXPECT_LT(error, 200 * tolerance + 2e-12) << tolerance;
    EXPECT_LT(error, last + 1e-12) << tolerance;
    EXPECT_LT(run(problem, tolerance, 7).first, 200 * tolerance + 2e-12) << tolerance;
    last = error;
  }
}

TEST(ExtrapolatedSplitting, FollowsItsTolerance) {
  follows_its_tolerance(swing());
  follows_its_tolerance(orbit());
  follows_its_tolerance(body());
  follows_its_tolerance(top());
  follows_its_tolerance(lagrange_top());
  follows_its_tolerance(bob());
}

/// What rounding leaves in the coordinates of an arrow is no error, however short the way.
TEST(ExtrapolatedSplitting, ReachesNearNodesAtOnce) {
  const auto at_once = [](auto problem) {
    for (const double h : {1e-2, 1e-4, 1e-7}) {
      problem.horizon = h;
      for (const double tolerance : {1e-10, 1e-14}) {
        auto integrator = extrapolated(problem, tolerance);
        const StepReport report = integrator.advance();
        EXPECT_TRUE(report.converged()) << h;
        EXPECT_LT(report.iterations, 200) << h << " by " << tolerance;
      }
    }
  };
  at_once(body());
  at_once(top());
  at_once(bob());
  at_once(orbit());
}

/// Nine digits for fewer Strang steps than the composition of order eight takes.
TEST(ExtrapolatedSplitting, TakesFewStrangStepsForManyDigits) {
  const auto costs_less = [](const auto& problem) {
    const auto [error, steps] = run(problem, 1e-11);
    const Composition& eighth = compositions::kahan_li_8;
    for (int n = problem.steps;; n += n / 4) {
      auto system = problem.system;
      system.h = problem.horizon / n;
      auto composed = make(system, problem.start, eighth);
      for (int i = 0; i < n; ++i) ASSERT_TRUE(composed.advance().converged());
      if (problem.error(composed.point()) > std::max(error, 1e-11)) continue;
      EXPECT_LT(1.5 * double(steps), double(n) * eighth.stages());
      break;
    }
  };
  costs_less(swing());
  costs_less(orbit());
  costs_less(top());
}

/// Flows that take a double alone, one row after the other.
struct OneByOne : HeavyTop {
  template <int Part, class S>
  FlowOf<GroupoidType, S> flow(double t, const Vector<S, 3>& v, const Vector<S, 3>& mu) const {
    return HeavyTop::flow<Part>(t, v, mu);
  }
};

TEST(ExtrapolatedSplitting, LanesHoldWhatOneLaneWould) {
  static_assert(SplitInLanes<HeavyTop, RowBatch>);
  static_assert(!SplitInLanes<OneByOne, RowBatch>);
  const auto problem = top();
  OneByOne alone;
  static_cast<HeavyTop&>(alone) = problem.system;
  const Problem<OneByOne> the_same{alone, {problem.start.object, problem.start.momentum}, problem.horizon, 1, nullptr};
  auto many = extrapolated(problem, 1e-12);
  auto one = extrapolated(the_same, 1e-12);
  ASSERT_TRUE(many.advance().converged());
  ASSERT_TRUE(one.advance().converged());
  EXPECT_LT((many.point().state.momentum - one.point().state.momentum).norm(), 1e-11);
  EXPECT_LT((many.point().state.object - one.point().state.object).norm(), 1e-11);
}

TEST(ExtrapolatedSplitting, StaysOnObjectConstraints) {
  auto problem = bob();
  for (const double tolerance : {1e-3, 1e-12}) {
    auto integrator = extrapolated(problem, tolerance, 20);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(integrator.advance().converged());
      const auto& z = integrator.point().state;
      // Off by the square of what was left across.
      EXPECT_LT(std::abs(z.object.norm() - 1), tolerance * tolerance + 1e-15);
      EXPECT_LT(std::abs(z.object.dot(z.momentum)), tolerance * tolerance + 1e-15);
    }
  }
}

TEST(ExtrapolatedSplitting, GoesBackAsFarAsItsTolerance) {
  auto problem = orbit();
  problem.horizon = 2;
  auto there = extrapolated(problem, 1e-12);
  ASSERT_TRUE(there.advance().converged());
  Kepler back = problem.system;
  back.h = -2;
  ExtrapolatedSplitting<Kepler> integrator(back, there.point().state, there.point().configuration, 1e-12);
  ASSERT_TRUE(integrator.advance().converged());
  EXPECT_LT((integrator.point().state.object - problem.start.object).norm(), 1e-10);
}

/// A share of a node is a node of its own, and what is taken up goes on with the same bits.
TEST(ExtrapolatedSplitting, IsCutAndTakenUp) {
  const auto problem = swing();
  Pendulum system = problem.system;
  system.h = 0.5;
  const auto begin = [&] {
    return detail::IntegratorOf<Pendulum, ExtrapolatedSplitting<Pendulum>>(
        system, problem.start, system.groupoid.unit(problem.start.object), 1e-11);
  };
  auto whole = begin();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(whole.advance().converged());
  NumberArchive kept;
  whole.serialize(kept);
  auto taken_up = begin();
  NumberArchive read(kept.numbers());
  taken_up.serialize(read);
  EXPECT_TRUE(read.at_end());
  whole.keep_node();
  ASSERT_TRUE(whole.advance().converged());
  ASSERT_TRUE(taken_up.advance().converged());
  EXPECT_EQ(whole.point().state.momentum, taken_up.point().state.momentum);
  EXPECT_EQ(whole.point().state.object, taken_up.point().state.object);
  TrajectoryPoint<Pendulum> inside;
  ASSERT_TRUE(whole.cut(0.4, inside).converged());
  const auto exact = system.reference(problem.start, 1.5 + 0.2);
  EXPECT_NEAR(inside.state.object(0), exact.object(0), 1e-9);
  EXPECT_EQ(whole.point().state.object, taken_up.point().state.object);
}

TEST(ExtrapolatedSplitting, SaysWhyItStops) {
  // Let go from rest it falls into the centre at t = pi / 2^(3/2).
  Kepler falling;
  falling.h = 1;
  const State<Pair<2>> start{{1, 0}, {0, 0}};
  ExtrapolatedSplitting<Kepler> orbit(falling, start, Pair<2>::unit(start.object), 1e-10);
  ASSERT_TRUE(orbit.advance().converged());
  const auto before = orbit.point().state;
  const StepReport report = orbit.advance();
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(orbit.point().state.object, before.object);
  EXPECT_EQ(orbit.point().index, 1);
  EXPECT_THROW(ExtrapolatedSplitting<Kepler>(falling, start, Pair<2>::unit(start.object), 0), std::invalid_argument);
  EXPECT_THROW(ExtrapolatedSplitting<Kepler>(falling, start, Pair<2>::unit(Vector<double, 2>(2, 0)), 1e-6),
               std::invalid_argument);
}

TEST(ExtrapolatedSplitting, AllocatesNothingInAStep) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  auto integrator = extrapolated(top(), 1e-9, 10);
  ASSERT_TRUE(integrator.advance().converged());
  const long before = allocation_count();
  for (int i = 0; i < 9; ++i) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace lagroid::splitting_tests::extrapolated_tests
