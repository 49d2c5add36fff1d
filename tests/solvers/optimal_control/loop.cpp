// Model predictive control: a problem solved anew at every sample, from the last plan and its multipliers.
#include "../../support/allocation_counter.hpp"
#include "../satellite_loop.hpp"

#include <lagroid/solvers/control/control_loop.hpp>
#include <lagroid/systems/control/flows/double_integrator.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lagroid::optimal_control_loop_tests {
namespace {

using satellite_loop::Chance;
using satellite_loop::turn;

TEST(ControlLoops, ASampleTakesAFewIterations) {
  ControlLoop<SatelliteTurn> loop(turn(), 50);
  ASSERT_TRUE(loop.begin().converged());
  Chance chance(0.003);
  std::vector<int> iterations;
  constexpr int samples = 120;
  for (int k = 0; k < samples; ++k) {
    const ControlReport report = loop.advance(loop.followed(chance()));
    ASSERT_TRUE(report.converged()) << "sample " << k << ": " << to_string(report.status);
    EXPECT_LE(report.stationarity, 1e-8);
    EXPECT_LE(report.violation, 1e-8);
    EXPECT_LE(report.complementarity, 1e-8);
    EXPECT_LE(loop.control().cwiseAbs().maxCoeff(), 0.6);
    iterations.push_back(report.iterations);
  }
  std::sort(iterations.begin(), iterations.end());
  EXPECT_LE(iterations[samples / 2], 6);
  EXPECT_LE(iterations.back(), 20);
  EXPECT_EQ(loop.latency().count(), samples);
  // It holds the satellite where it is to be.
  const Vector<double, 6> left = SatelliteTurn::GroupoidType().tau_inverse(loop.followed());
  EXPECT_LT(left.norm(), 0.1);
}

TEST(ControlLoops, AControlIsWithinItsBoundsWhereNoPlanIs) {
  ControlLoop<SatelliteTurn> loop(turn(), 30);
  ASSERT_TRUE(loop.begin().converged());
  Vector<double, 6> off;
  off << 0, 0, 0, 100, 0, 0;
  EXPECT_FALSE(loop.advance(loop.followed(off)).converged());
  EXPECT_GT(loop.plan().controls.front().cwiseAbs().maxCoeff(), 0.6);
  EXPECT_LE(loop.control().cwiseAbs().maxCoeff(), 0.6);
}

// The plan of a sample is what a solve from nothing finds.
TEST(ControlLoops, PlansAreThoseOfSolvesFromNothing) {
  ControlTask<SatelliteTurn> task = turn();
  ControlLoop<SatelliteTurn> loop(task, 30);
  ASSERT_TRUE(loop.begin().converged());
  Chance chance(0.01);
  for (int k = 0; k < 12; ++k) {
    task.boundary = loop.followed(chance());
    const ControlReport report = loop.advance(task.boundary);
    ASSERT_TRUE(report.converged()) << k;
    const auto anew = solve_control(task, 30);
    ASSERT_TRUE(anew.report.converged()) << k;
    EXPECT_NEAR(report.cost, anew.report.cost, 1e-6 * anew.report.cost) << k;
    EXPECT_LT((loop.control() - anew.trajectory.controls.front()).norm(), 1e-5) << k;
  }
}

TEST(ControlLoops, ASampleAllocatesNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  ControlLoop<SatelliteTurn> loop(turn(), 20);
  ASSERT_TRUE(loop.begin().converged());
  Chance chance(0.01);
  loop.advance(loop.followed(chance()));
  const long before = allocation_count();
  for (int k = 0; k < 30; ++k) loop.advance(loop.followed(chance()));
  EXPECT_EQ(allocation_count() - before, 0);
}

// One iteration a sample: plans are not those of the problem, but come to be.
TEST(ControlLoops, RealTimeIterationsContract) {
  ControlLoop<SatelliteTurn> loop(turn(), 50, {.iterations = 1});
  ASSERT_TRUE(loop.begin().converged());
  double violation = 0;
  for (int k = 0; k < 100; ++k) {
    const ControlReport report = loop.advance(loop.followed());
    EXPECT_LE(report.iterations, 1);
    EXPECT_LE(loop.control().cwiseAbs().maxCoeff(), 0.6 + 0.05) << k;
    violation = report.violation;
    EXPECT_TRUE(report.is_usable(0.1)) << k << ": " << violation;
  }
  EXPECT_LT(violation, 1e-6);
  EXPECT_LT(SatelliteTurn::GroupoidType().tau_inverse(loop.followed()).norm(), 0.05);
}

// On R^2: a cart that is to stop, and is pushed off by more than its brakes can take back in the time that is left.
TEST(ControlLoops, WhatCannotBeIsTypedAndTheLoopStartsAnew) {
  using Line = FlowStates<Pair<2>>;
  ControlTask<DoubleIntegrator> task{{}, Line::arrow({1, 0}, {0, 0}), 3};
  task.lower(0) = -1;
  task.upper(0) = 1;
  ControlLoop<DoubleIntegrator> loop(task, 30, {.iterations = 60});
  ASSERT_TRUE(loop.begin().converged());
  ASSERT_TRUE(loop.advance(loop.followed()).converged());
  const ControlReport far = loop.advance(Line::arrow({50, 0}, {0, 0}));
  EXPECT_LE(far.iterations, 60);
  EXPECT_FALSE(far.converged());
  EXPECT_FALSE(far.is_usable(1e-3));
  EXPECT_TRUE(loop.restart(Line::arrow({0.5, 0}, {0, 0})).converged());
  EXPECT_TRUE(loop.advance(loop.followed()).converged());
  EXPECT_EQ(loop.restarts(), 0);
  EXPECT_TRUE(loop.follow(Line::arrow({0.4, 0}, {0, 0}), 1e-3).converged());
  const ControlReport none = loop.advance(Line::arrow({std::nan(""), 0}, {0, 0}));
  EXPECT_FALSE(none.is_usable(1e9)) << to_string(none.status);
}

// Limits are those of a sample, restoration included; further iterations go on from where it stopped.
TEST(ControlLoops, KeepTheirLimitOfIterations) {
  for (const int most : {1, 2, 5}) {
    ControlLoop<SatelliteTurn> loop(turn(), 20, {.iterations = most});
    ASSERT_TRUE(loop.begin().converged());
    Chance chance(0.2);
    for (int k = 0; k < 10; ++k) EXPECT_LE(loop.advance(loop.followed(chance())).iterations, most);
  }
}
TEST(ControlLoops, BeginWithAKnownSolution) {
  const auto task = turn();
  const auto known = solve_control(task, 30);
  ASSERT_TRUE(known.report.converged());
  ControlLoop<SatelliteTurn> loop(task, known);
  const ControlReport first = loop.begin();
  ASSERT_TRUE(first.converged());
  EXPECT_LE(first.iterations, 6);
  EXPECT_NEAR(first.cost, known.report.cost, 1e-7 * known.report.cost);
}

TEST(ControlLoops, RefuseWhatTheyCannotLookAheadFor) {
  ControlTask<SatelliteTurn> task = turn();
  task.duration_is_free = true;
  EXPECT_THROW(ControlLoop<SatelliteTurn>(task, 20), std::invalid_argument);
  task.duration_is_free = false;
  EXPECT_THROW(ControlLoop<SatelliteTurn>(task, 1), std::invalid_argument);
  task.free_end[3] = true;
  EXPECT_THROW(ControlLoop<SatelliteTurn>(task, 20), std::invalid_argument);
  task.free_end[3] = false;
  task.lower = 2 * task.upper;
  EXPECT_THROW(ControlLoop<SatelliteTurn>(task, 20), std::invalid_argument);
}

TEST(Latencies, ArePercentilesToFivePercent) {
  Latency latency;
  EXPECT_EQ(latency.percentile(50), 0);
  for (int i = 1; i <= 1000; ++i) latency.add(1e-5 * i);
  EXPECT_NEAR(latency.percentile(50), 5e-3, 0.05 * 5e-3);
  EXPECT_NEAR(latency.percentile(99), 9.9e-3, 0.05 * 9.9e-3);
  EXPECT_EQ(latency.percentile(100), 1e-2);
  EXPECT_EQ(latency.longest(), 1e-2);
  latency.add(1e9);
  EXPECT_EQ(latency.percentile(100), 1e9);
}

}  // namespace
}  // namespace lagroid::optimal_control_loop_tests
