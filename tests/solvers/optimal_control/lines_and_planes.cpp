// Optimal control on pair groupoids against reference solutions: double integrators, a pendulum, obstacles, orbits.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/low_thrust.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include <numbers>

namespace lagroid::optimal_control_lines_and_planes_tests {
namespace {

using control_tests::expect_laws;
using control_tests::expect_second_order;

template <class Sys>
ControlTask<Sys> task_on(typename FlowStates<typename Sys::GroupoidType>::State start,
                         typename FlowStates<typename Sys::GroupoidType>::State end, double duration) {
  return {{}, {start, end}, duration};
}

ControlTask<DoubleIntegrator> fastest(double x0, double v0, double x1, double v1) {
  auto task = task_on<DoubleIntegrator>({x0, v0}, {x1, v1}, 3);
  task.system.cost_of = ControlCost::time;
  task.duration_is_free = true;
  task.lower(0) = -1;
  task.upper(0) = 1;
  return task;
}

TEST(DoubleIntegrators, FastestWaysAreBangBang) {
  expect_second_order("rest to rest", fastest(0, 0, 1, 0), 2, 6.5e-4, false, 3);
  expect_second_order("stop", fastest(0, 1, 0, 0), 1 + std::numbers::sqrt2, 2.1, false, 3);
  expect_second_order("forward", fastest(-1, 1, 2, -0.5), 3.3078865529319543, 1.31, false, 3);
  expect_second_order("speed up", fastest(1, -0.3, 1.5, 0.8), 1.3601075237738276, 0.49, false, 3);
}

TEST(DoubleIntegrators, CheapestWaysRestOnTheBoundOfTheSpeed) {
  auto task = task_on<DoubleIntegrator>({0, 0}, {1, 0}, 1);
  task.system.largest_speed = 1.25;
  expect_second_order("one", task, 125.0 / 9, 38.8, true, 2);
  task = task_on<DoubleIntegrator>({0, 0.4}, {2, 0}, 2);
  task.system.largest_speed = 1.3;
  expect_second_order("two", task, 4.042294070648682, 6.2, false, 2);
}

// From rest towards x = 1 in a time T: effort, and w (x - 1)^2 at an end that is free. With the force constant over
// stages the least is w / (1 + w S), S = T^3 / 3 - T h^2 / 12.
TEST(DoubleIntegrators, ACostOfTheEndIsWeighedAgainstEffort) {
  constexpr double weight = 5, duration = 2;
  auto task = task_on<DoubleIntegrator>({0, 0}, {1, 0}, duration);
  task.free_end.fill(true);
  task.end_cost = node_condition<Pair<2>, 1>([]<class S>(const PairArrow<S, 2>& p) {
    return Vector<S, 1>((p.target(0) - 1.0) * (p.target(0) - 1.0) * weight);
  });
  for (const long stages : {20L, 100L}) {
    const auto found = solve_control(task, stages);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    EXPECT_TRUE(found.report.is_strict_minimum());
    const double h = duration / double(stages);
    const double s = duration * duration * duration / 3 - duration * h * h / 12;
    EXPECT_NEAR(found.report.cost, weight / (1 + weight * s), 1e-13);
    // The costate of x at the end is minus the slope of that cost there.
    const double off = 1 / (1 + weight * s);
    EXPECT_NEAR(found.costates.back()[0], 2 * weight * off, 1e-12);
  }
  expect_laws(task, 20);
  task.end_cost = node_condition<Pair<2>, 2>([]<class S>(const PairArrow<S, 2>& p) { return p.target; });
  EXPECT_THROW(solve_control(task, 20), std::invalid_argument);
  task.end_cost =
      node_condition<Pair<2>, 1>([]<class S>(const PairArrow<S, 2>& p) { return Vector<S, 1>(p.target(0)); });
  task.free_end.fill(false);
  EXPECT_THROW(solve_control(task, 20), std::invalid_argument);
}

TEST(PlanarMasses, FastestWithABoundedForce) {
  auto task = task_on<PlanarMass>({0, 0, 1, 0}, {2, 1.5, 0, 0}, 3);
  task.system.cost_of = ControlCost::time;
  task.system.largest_force = 1;
  task.duration_is_free = true;
  expect_second_order("planar", task, 2.648749577047721, 0.37, false, 2);
}

// Along each axis the cheapest motion is what it is without the other, so that its cost goes by its weight.
TEST(PlanarMasses, WeightsAreOfEachForceAndOfTheTime) {
  const auto cost = [](double x, double y, const ControlWeights<2>& weights) {
    auto task = task_on<PlanarMass>({0, 0, 0, 0}, {x, y, 0, 0}, 2);
    task.system.weights = weights;
    return solve_control(task, 30).report.cost;
  };
  const double along_x = cost(1, 0, {}), along_y = cost(0, 2, {});
  EXPECT_NEAR(along_y, 4 * along_x, 1e-12);
  EXPECT_NEAR(cost(1, 2, {{3, 0.5}, 0}), 3 * along_x + 0.5 * along_y, 1e-12);
  EXPECT_NEAR(cost(1, 2, {{3, 0.5}, 0.7}), 3 * along_x + 0.5 * along_y + 2 * 0.7, 1e-12);
}

// 12 d^2 / T^3 + w T is least where T^4 = 36 d^2 / w. It is found from any guess of T.
TEST(DoubleIntegrators, TimeAndEffortAreWeighedAgainstEachOther) {
  auto task = task_on<DoubleIntegrator>({0, 0}, {1, 0}, 2);
  task.duration_is_free = true;
  constexpr double weight = 2.25;
  task.system.weights = {{Vector<double, 1>(1.0), weight}};
  const double best = std::pow(36 / weight, 0.25);
  for (const double guess : {0.1, 0.5, 2.0, 30.0})
    for (const long stages : {50, 100}) {
      task.duration = guess;
      const auto found = solve_control(task, stages);
      ASSERT_TRUE(found.report.converged()) << guess << ": " << found.report.message;
      EXPECT_LE(found.report.iterations, 20) << guess;
      const double square = double(stages) * double(stages);
      EXPECT_NEAR(found.trajectory.duration(), best, 2 * best / square);
      EXPECT_NEAR(found.report.cost, 12 / (best * best * best) + weight * best, 10 / square);
    }
  expect_laws(task, 20);
}

TEST(PlanarMasses, KeepOutOfADisk) {
  auto task = task_on<PlanarMass>({-2, -0.3, 0, 0}, {2, 0.2, 0, 0}, 4);
  task.system.disk_radius = 1;
  expect_second_order("touch", task, 5.7566109957441824, 12.1, false, 4);
  task = task_on<PlanarMass>({-1.2, -0.1, 0, 0}, {1.3, -0.3, 0, 0}, 4);
  task.system.disk_radius = 1;
  expect_second_order("arc", task, 3.151350129280076, 8.7, false, 4);
}

// The disk's inequality at an end that is fixed can have any multiplier, and is no measure of the others.
TEST(PlanarMasses, AnEndOnTheRimLeavesNoResidual) {
  auto task = task_on<PlanarMass>({-2, -0.3, 0, 0}, {1, 0, 0, 0}, 4);
  task.system.disk_radius = 1;
  const auto found = search_control(task, 100, {.starts = 10});
  ASSERT_EQ(found.minima.size(), 2U) << "above the disk, and below";
  for (const auto& each : found.minima) {
    EXPECT_LT(each.report.stationarity, 1e-9) << each.report.cost;
    EXPECT_LT(each.report.violation, 1e-12);
    EXPECT_LT(each.report.complementarity, 1e-9);
  }
}

TEST(SwingUps, BothWithAndWithoutABoundOfTheTorque) {
  auto task = task_on<SwingUp>({0, 0}, {std::numbers::pi, 0}, 10);
  expect_second_order("free", task, 1.1611196661425072, 28.6, true);
  task.lower(0) = -0.5;
  task.upper(0) = 0.5;
  expect_second_order("bounded", task, 1.1639915199984323, 29.3, true);
}

TEST(SwingUps, CompetingMinimaAreFound) {
  const auto task = task_on<SwingUp>({0, 0}, {std::numbers::pi, 0}, 10);
  const auto found = search_control(task, 100, {.starts = 12});
  ASSERT_GE(found.minima.size(), 2U);
  EXPECT_LT(found.minima[0].report.cost + 0.01, found.minima[1].report.cost);
}

TEST(LowThrusts, WithAndWithoutABound) {
  auto task = task_on<LowThrust>({1, 0, 0, 1},
                                 {-0.980465431295418, -1.1352037429618922, 0.6179266498564948, -0.5336977815803581}, 6);
  expect_second_order("free", task, 0.016325954401309347, 1.95, true, 6);
  task.system.largest_thrust = 0.09;
  const auto found = search_control(task, 200, {.starts = 6});
  ASSERT_FALSE(found.minima.empty());
  EXPECT_NEAR(found.minima.front().report.cost, 0.01856436526236254, 5 * 3.6 / 4e4);
}

TEST(ControlOnPairs, DerivativesAndOptimality) {
  auto swing = task_on<SwingUp>({0, 0}, {std::numbers::pi, 0}, 10);
  swing.lower(0) = -0.5;
  swing.upper(0) = 0.5;
  expect_laws(swing, 30);
  expect_laws(fastest(0, 1, 0, 0), 20);
}

}  // namespace
}  // namespace lagroid::optimal_control_lines_and_planes_tests
