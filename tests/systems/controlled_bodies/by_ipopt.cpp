// Optimal control of scenes of bodies by IPOPT, from the same starts as by the library.
#include "tasks.hpp"

#include <lagroid/solvers/missing_library.hpp>
#include <lagroid/systems/multibody/control/ipopt/scene_chart.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace lagroid::controlled_bodies_by_ipopt_tests {
namespace {

using namespace controlled_bodies_tests;

/// The largest difference of places, attitudes, momenta and strengths of controls.
double distance(const ControlledScene& scene, const ScenePath& a, const ScenePath& b) {
  double most = std::abs(a.step - b.step) * double(a.stages());
  for (std::size_t k = 0; k < a.nodes.size(); ++k)
    most = std::max({most, scene.difference(a.nodes[k], b.nodes[k]).lpNorm<Eigen::Infinity>(),
                     (a.nodes[k].momenta - b.nodes[k].momenta).lpNorm<Eigen::Infinity>()});
  for (long k = 0; k < a.stages(); ++k)
    for (int j = 0; j < scene.actuators(); ++j) most = std::max(most, std::abs(a.controls[k][j] - b.controls[k][j]));
  return most;
}

/// From these starts: where both find a minimum of the same cost, to 1e-8, it is the same path, and from one start at
/// least they do. One of them may fail, or they may find different minima.
void expect_agreement(const std::string& name, const SceneControl& task, const std::vector<int>& starts) {
  if (!has_ipopt()) GTEST_SKIP() << "a build without IPOPT";
  ControlledScene scene(task);
  int agreed = 0;
  for (const int start : starts) {
    const SceneSolution ours = solve_scene(scene, scene_guess(scene, start));
    const SceneSolution theirs = solve_scene_by_ipopt(scene, scene_guess(scene, start));
    if (!ours.report.converged() || !theirs.report.converged()) continue;
    EXPECT_LE(theirs.report.stationarity, 1e-7) << name << start;
    EXPECT_LE(theirs.report.violation, 1e-9) << name << start;
    EXPECT_LE(theirs.report.complementarity, 1e-7) << name << start;
    EXPECT_TRUE(theirs.report.is_strict_minimum()) << name << start;
    if (std::abs(theirs.report.cost - ours.report.cost) > 1e-8 * ours.report.cost) continue;
    ++agreed;
    EXPECT_LE(distance(scene, ours.path, theirs.path), 1e-6) << name << start;
  }
  EXPECT_GE(agreed, 1) << name;
}

TEST(ControlledBodiesByIpopt, AnArmReaches) {
  SceneControl task = reach(0);
  task.stages = 30;
  expect_agreement("free", task, {0});
  task.actuators[0].lower = -6;
  task.actuators[1].upper = 1.5;
  expect_agreement("bounded", task, {0});
  task = reach(0);
  task.stages = 30;
  task.speed_limits = {{.linear = 1, .axes = {0, 1}, .most = 1.5}};
  expect_agreement("at a speed", task, {0});
  task = reach_of<DampedArm>(0);
  task.stages = 30;
  expect_agreement("damped", task, {0});
  task = reach(0.3);
  task.stages = 30;
  expect_agreement("round a disk", task, {0, 1, 2, 3});
}

TEST(ControlledBodiesByIpopt, ACatTurns) {
  SceneControl task = turning_cat(0.8);
  task.stages = 10;
  expect_agreement("cat", task, {3, 4});
}

TEST(ControlledBodiesByIpopt, ABuildWithoutItSaysSo) {
  if (has_ipopt()) GTEST_SKIP() << "a build with IPOPT";
  SceneControl task = reach(0);
  task.stages = 4;
  ControlledScene scene(task);
  EXPECT_THROW(solve_scene_by_ipopt(scene, scene_guess(scene, 0)), MissingLibrary);
}

}  // namespace
}  // namespace lagroid::controlled_bodies_by_ipopt_tests
