// Costs and motions of controlled scenes of bodies: those of the same machines written in angles, and of the
// differential equations; what nothing outside changes is kept on every grid.
#include "tasks.hpp"

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/systems/control/actuated/two_link_arm.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>
#include <lagroid/systems/multibody/testing/scene_control_laws.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lagroid::controlled_bodies_solutions_tests {
namespace {

using namespace controlled_bodies_tests;
using multibody::Vec;

/// From the start of this index alone, which is one that leads to the cheapest solution.
SceneSolution solved(ControlledScene& scene, int index) { return solve_scene(scene, scene_guess(scene, index)); }

SceneControl swing_up(double bound) {
  SceneControl task = control_of_scene(HingedBar{});
  task.actuators = {{"motor", -bound, bound}};
  task.end = at_rest({{HingedBar::of_bar, {-0.5, 0, std::numbers::pi}}});
  task.duration = 10;
  return task;
}

void expect_cost(SceneControl task, double reference) {
  double costs[3];
  int at = 0;
  for (const long stages : {100L, 200L, 400L}) {
    task.stages = stages;
    ControlledScene scene(task);
    const SceneSolution best = solved(scene, 7);
    ASSERT_TRUE(best.report.converged()) << stages << ": " << best.report.message;
    EXPECT_LE(best.report.violation, 1e-10);
    EXPECT_LE(best.report.stationarity, 1e-10);
    EXPECT_TRUE(best.report.is_strict_minimum());
    costs[at++] = best.report.cost;
  }
  EXPECT_NEAR((4 * costs[2] - costs[1]) / 3, reference, 1e-5 * reference);
  EXPECT_NEAR(std::log2((costs[0] - reference) / (costs[1] - reference)), 2, 0.1);
}

TEST(ControlledBodies, SwingUpAtTheCostOfTheirEquation) {
  expect_cost(swing_up(HUGE_VAL), 1.1611196661425072);
  expect_cost(swing_up(0.5), 1.1639915199984323);
}

double cost_in_angles(double radius, long stages) {
  ControlTask<PushedArm> task{{}, FlowStates<PushedArm::GroupoidType>::arrow({0, 0.3, 0, 0}, {1.6, 0.3, 0, 0}), 2};
  task.system.system.disk_center = {1, 1};
  task.system.system.disk_radius = radius;
  const auto found = search_control(task, stages, {.starts = 4});
  return found.minima.empty() ? NAN : found.minima.front().report.cost;
}

// Steps along chords of the plane are others than those in angles, and both are of order two.
TEST(ControlledBodies, AnArmReachesAtTheCostOfItsAngles) {
  double of_bodies[2], in_angles[2];
  for (int k = 0; k < 2; ++k) {
    const long stages = k == 0 ? 40 : 80;
    SceneControl task = reach(0);
    task.stages = stages;
    const SceneSearch found = search_scene(task, {.starts = 3});
    ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
    of_bodies[k] = found.minima.front().report.cost;
    in_angles[k] = cost_in_angles(0, stages);
  }
  const auto extrapolated = [](const double(&costs)[2]) { return (4 * costs[1] - costs[0]) / 3; };
  EXPECT_NEAR(extrapolated(of_bodies), extrapolated(in_angles), 1e-5 * in_angles[1]);
  EXPECT_GT(std::abs(of_bodies[1] - in_angles[1]), 1e-6 * in_angles[1]);
}

TEST(ControlledBodies, AnArmReachesRoundADisk) {
  SceneControl task = reach(0.3);
  task.stages = 60;
  ControlledScene scene(task);
  const SceneSolution best = solved(scene, 3);
  ASSERT_TRUE(best.report.converged()) << best.report.message;
  EXPECT_GT(best.crossover.active, 0);
  EXPECT_NEAR(best.report.cost, cost_in_angles(0.3, 60), 2e-3 * best.report.cost);
  const laws::LawReport report = laws::scene_control_laws(scene, best);
  EXPECT_TRUE(report.holds()) << report;
  SceneSolution broken = best;
  broken.costates[3][0] += 0.1;
  EXPECT_FALSE(laws::scene_control_laws(scene, broken).holds());
}

Vec angular_momentum(const ControlledScene& scene, const ControlledNode& node) {
  Vec sum = Vec::Zero();
  for (int f = 0; f < scene.factors(); ++f) {
    const Vec p = node.momenta.segment<3>(3 * f);
    sum += f < scene.linear() ? Vec(node.places[std::size_t(f)].cross(p))
                              : Vec(node.attitudes[std::size_t(f - scene.linear())] * p);
  }
  return sum;
}

TEST(ControlledBodies, ACatTurnsWithoutAngularMomentum) {
  SceneControl task = turning_cat(0.8);
  std::vector<double> costs;
  for (const long stages : {10L, 20L, 40L}) {
    task.stages = stages;
    ControlledScene scene(task);
    const SceneSolution best = solved(scene, 4);
    ASSERT_TRUE(best.report.converged()) << stages << ": " << best.report.message;
    costs.push_back(best.report.cost);
    double most = 0, moved = 0;
    for (const ControlledNode& node : best.path.nodes) {
      most = std::max(most, angular_momentum(scene, node).norm());
      moved = std::max(moved, node.momenta.norm());
    }
    EXPECT_LE(most, 1e-12) << stages;
    EXPECT_GT(moved, 1e-2);
  }
  EXPECT_NEAR(std::log2((costs[0] - costs[1]) / (costs[1] - costs[2])), 2, 0.4);
}

// What of an end is free is where it costs the least.
TEST(ControlledBodies, AnEndThatIsFreeInPartCostsLess) {
  SceneControl task = reach(0);
  task.stages = 30;
  const SceneSearch whole = search_scene(task, {.starts = 2});
  task.end.places = {{{Arm::of_points[3]}, 0, std::cos(1.6) + std::cos(1.9)},
                     {{Arm::of_points[3]}, 1, std::sin(1.6) + std::sin(1.9)}};
  const SceneSearch at_rest = search_scene(task, {.starts = 2});
  task.end.velocities.clear();
  const SceneSearch hand = search_scene(task, {.starts = 2});
  ASSERT_FALSE(whole.minima.empty() || at_rest.minima.empty() || hand.minima.empty());
  EXPECT_LE(at_rest.minima.front().report.cost, whole.minima.front().report.cost * (1 + 1e-9));
  EXPECT_LT(hand.minima.front().report.cost, 0.9 * at_rest.minima.front().report.cost);
}

}  // namespace
}  // namespace lagroid::controlled_bodies_solutions_tests
