// Solutions in which cones and speed limits are active.
#include "tasks.hpp"

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>
#include <lagroid/systems/multibody/testing/scene_control_laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lagroid::controlled_bodies_limits_tests {
namespace {

using namespace controlled_bodies_tests;
using multibody::Vec;

/// That the laws of the solution hold, complementarity among them, and that they fail with another multiplier of the
/// first limit.
void expect_laws(ControlledScene& scene, const SceneSolution& found) {
  const laws::LawReport report = laws::scene_control_laws(scene, found);
  EXPECT_TRUE(report.holds()) << report;
  SceneSolution broken = found;
  broken.inequality_multipliers[0][0] += 0.1;
  EXPECT_FALSE(laws::scene_control_laws(scene, broken).holds());
}

TEST(ControlledBodies, AnArmKeepsToASpeed) {
  SceneControl task = reach(0);
  task.stages = 40;
  ControlledScene without(task);
  const SceneSolution faster = solve_scene(without, scene_guess(without, 0));
  ASSERT_TRUE(faster.report.converged()) << faster.report.message;
  constexpr double most_of_place = 1.5, most_of_turning = 0.95;
  task.speed_limits = {{.linear = 1, .axes = {0, 1}, .most = most_of_place},
                       {.linear = 0, .axes = {2}, .most = most_of_turning}};
  ControlledScene scene(task);
  const SceneSolution found = solve_scene(scene, scene_guess(scene, 0));
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_GT(found.report.cost, 1.001 * faster.report.cost);
  EXPECT_GT(found.crossover.active, 0);
  const auto fastest = [](ControlledScene& of, const ScenePath& path) {
    double place = 0, turning = 0;
    for (const ControlledNode& node : path.nodes) {
      const std::vector<double> v = of.velocities(node);
      place = std::max(place, std::hypot(v[3], v[4]));
      turning = std::max(turning, std::abs(v[2]));
    }
    return std::pair(place, turning);
  };
  EXPECT_GT(fastest(without, faster.path).first, 1.05 * most_of_place);
  EXPECT_GT(fastest(without, faster.path).second, 1.05 * most_of_turning);
  EXPECT_NEAR(fastest(scene, found.path).first, most_of_place, 1e-9);
  EXPECT_NEAR(fastest(scene, found.path).second, most_of_turning, 1e-9);
  expect_laws(scene, found);
}

/// That velocities of a point of a scene are those by which it moves, to the order of the steps.
void expect_velocities(ControlledScene& scene, const ScenePath& path, multibody::Site point) {
  const auto place = [&](std::size_t k) { return Vec(scene.forces(path.nodes[k])(point)); };
  double fastest = 0, off = 0;
  for (std::size_t k = 1; k + 1 < path.nodes.size(); ++k) {
    const Vec moved = (place(k + 1) - place(k - 1)) / (2 * path.step);
    const std::vector<double> velocities = scene.velocities(path.nodes[k]);
    off = std::max(off, (Vec(velocities.data() + scene.n()) - moved).norm());
    fastest = std::max(fastest, moved.norm());
  }
  EXPECT_LE(off, 0.02 * fastest);
}

TEST(ControlledBodies, AHandKeepsToASpeed) {
  SceneControl task = reach(0);
  task.stages = 60;
  constexpr double most = 2.2;
  task.speed_limits = {{.site = Arm::of_hand, .most = most}};
  ControlledScene scene(task);
  const SceneSolution found = solve_scene(scene, scene_guess(scene, 0));
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_GT(found.crossover.active, 0);
  expect_velocities(scene, found.path, Arm::of_hand);
  double fastest = 0;
  for (const ControlledNode& node : found.path.nodes)
    fastest = std::max(fastest, Vec(scene.velocities(node).data() + scene.n()).norm());
  EXPECT_NEAR(fastest, most, 1e-9);
  expect_laws(scene, found);
}

// Of a light bar half a turn in one step would cost nothing, on any grid.
TEST(ControlledBodies, NoStepHidesAHalfTurn) {
  constexpr double inertia = 0.02, angle = 6;
  for (const long stages : {60, 120}) {
    SceneControl task = control_of_scene(HingedBar{.weight = 0, .inertia = inertia});
    task.actuators = {{"motor"}};
    task.duration = 2;
    task.stages = stages;
    task.end = at_rest({{HingedBar::of_bar, {0.5 * std::cos(angle), 0.5 * std::sin(angle), angle}}});
    ControlledScene scene(task);
    const SceneSearch found = search_scene(scene, {.starts = 10});
    ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
    const double momentum = (inertia + 0.25) * angle;
    const double cost = 12 * momentum * momentum / 8;
    for (const SceneSolution& each : found.minima) EXPECT_GE(each.report.cost, 0.99 * cost);
    EXPECT_NEAR(found.minima.front().report.cost, cost, 0.01 * cost);
    SceneSolution folded = found.minima.front();
    folded.path.nodes[5].places[0](2) += 3;
    refuse_wide_steps(scene, folded);
    EXPECT_EQ(folded.report.status, ControlStatus::infeasible);
    EXPECT_NE(folded.report.message.find("stage 5 turns a body by 3"), std::string::npos) << folded.report.message;
  }
}

// Velocities of a point of a body that turns in space, behind a joint.
TEST(ControlledBodies, PointsMoveByTheirVelocities) {
  SceneControl task = control_of_scene(Machine{});
  task.actuators = {{"rail"}};
  task.stages = 100;
  task.speed_limits = {{.site = Machine::of_top, .most = 10}};
  ControlledScene scene(task);
  const auto drift = scene.drift(task.stages);
  ASSERT_TRUE(drift);
  expect_velocities(scene, {*drift, {}, task.duration / double(task.stages)}, Machine::of_top);
}

/// The satellite of examples/control/keep_out.toml, as a scene.
SceneControl turn_of_satellite(const Vec& turn) {
  SceneControl task = control_of_scene(Satellite{});
  task.actuators = {{"torque1"}, {"torque2"}, {"torque3"}};
  task.duration = 5;
  task.stages = 50;
  task.end.turns = {{Satellite::of_body, SO3::quaternion(SO3::exp(turn))}};
  for (int i = 0; i < 3; ++i) task.end.turnings.push_back({Satellite::of_body, i, 0});
  return task;
}

// At the cost that it has as a flow on SO(3), to the order of both.
TEST(ControlledBodies, ASatelliteKeepsOffTheSun) {
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  const Vec turn(0.4, 1.9, 0.2);
  SceneControl task = turn_of_satellite(turn);
  task.cones = {{Satellite::of_body, {0, 0, 1}, satellite.avoided, satellite.cone, DirectionCone::Side::outside}};
  ControlledScene scene(task);
  const SceneSearch search = search_scene(scene, {.starts = 4});
  ASSERT_FALSE(search.minima.empty()) << search.best_failure.report.message;
  const SceneSolution& found = search.minima.front();
  EXPECT_GT(found.crossover.active, 0);
  double nearest = HUGE_VAL;
  for (const ControlledNode& node : found.path.nodes)
    nearest = std::min(nearest, std::acos(node.attitudes[0].col(2).dot(satellite.avoided)));
  EXPECT_NEAR(nearest, satellite.cone, 1e-9);

  using States = FlowStates<SatelliteTurn::GroupoidType>;
  States::State end = States::State::Zero();
  end.head<3>() = turn;
  const ControlTask<SatelliteTurn> flow{satellite, States::arrow(States::State::Zero(), end, satellite.avoided), 5};
  const auto as_flow = search_control(flow, task.stages, {.starts = 4});
  ASSERT_FALSE(as_flow.minima.empty());
  EXPECT_NEAR(found.report.cost, as_flow.minima.front().report.cost, 5e-3 * found.report.cost);
  expect_laws(scene, found);
}

// A quarter turn along which a direction would go far from another that it is near at both ends.
TEST(ControlledBodies, ABodyPointsInsideOfACone) {
  const double quarter = std::numbers::pi / 4;
  SceneControl task = turn_of_satellite({0, 0, 2 * quarter});
  const Vec direction(std::sqrt(0.25), -std::sqrt(0.25), std::sqrt(0.5));
  const Vec axis(-std::sin(0.7), 0, std::cos(0.7));
  constexpr double angle = 1.4;
  const auto farthest = [&](const ScenePath& path) {
    double most = 0;
    for (const ControlledNode& node : path.nodes)
      most = std::max(most, std::acos((node.attitudes[0] * direction).dot(axis)));
    return most;
  };
  ControlledScene without(task);
  const SceneSolution free = solve_scene(without, scene_guess(without, 0));
  ASSERT_TRUE(free.report.converged()) << free.report.message;
  EXPECT_GT(farthest(free.path), angle + 0.05);
  task.cones = {{Satellite::of_body, direction, axis, angle, DirectionCone::Side::inside}};
  ControlledScene scene(task);
  const SceneSolution found = solve_scene(scene, scene_guess(scene, 0));
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_NEAR(farthest(found.path), angle, 1e-9);
  EXPECT_GT(found.report.cost, free.report.cost);
  expect_laws(scene, found);
}

}  // namespace
}  // namespace lagroid::controlled_bodies_limits_tests
