// Derivatives of controlled scenes of bodies are those of their values, and without controls their steps are those of
// the simulation.
#include "scenes.hpp"

#include <lagroid/solvers/testing/control_laws.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <gtest/gtest.h>

namespace lagroid::controlled_bodies_derivatives_tests {
namespace {

using namespace controlled_bodies_tests;
using multibody::Vec;

SceneControl free_bodies() {
  SceneControl task = control_of_scene(FreeBodies{});
  task.actuators = {{"torque", -1, 1, 0.7}, {"force", -HUGE_VAL, 2}};
  task.keep_outs = {{FreeBodies::of_corner, KeepOut::Kind::sphere, {0.5, 0.5, 0.5}, 0.2},
                    {FreeBodies::of_bob, KeepOut::Kind::plane, {0, 0, -1}, 1, {0.6, 0, 0.8}},
                    {FreeBodies::of_corner, KeepOut::Kind::disk, {-0.5, 0.5, 0}, 0.3}};
  task.cones = {{FreeBodies::of_box, {0, 0.6, 0.8}, {1, 0, 0}, 0.9, DirectionCone::Side::outside},
                {FreeBodies::of_box, {0, 0, 1}, {0, 0, 1}, 1.4, DirectionCone::Side::inside}};
  task.speed_limits = {{.linear = 1, .most = 1.2},
                       {.attitude = FreeBodies::of_box, .axes = {0, 2}, .most = 0.8},
                       {.site = FreeBodies::of_corner, .most = 1.1}};
  task.end.places = {{FreeBodies::of_corner, 0, 0.5}, {FreeBodies::of_bob, 2, 0.1}};
  task.end.turns = {{FreeBodies::of_box, Quaternion(0.8, 0.6, 0, 0)}};
  task.end.velocities = {{0, 1, 0.3}};
  task.end.turnings = {{FreeBodies::of_box, 2, 0.4}};
  task.duration_is_free = true;
  task.duration_weight = 0.3;
  task.stages = 4;
  return task;
}

template <class Written = Machine> SceneControl machine(Retraction rotation) {
  SceneControl task = control_of_scene(Written{rotation});
  task.actuators = {{"rail"}, {"joint", -1, 1}};
  task.keep_outs = {{Machine::of_bob, KeepOut::Kind::sphere, {1.5, 0.5, -0.5}, 0.2}};
  task.cones = {{Machine::of_box, {1, 0, 0}, {0, 0, 1}, 1, DirectionCone::Side::outside}};
  task.speed_limits = {{.linear = 2, .most = 1.5},
                       {.attitude = Machine::of_box, .most = 2},
                       {.site = Machine::of_top, .axes = {0, 2}, .most = 2}};
  task.end.places = {{Machine::of_bob, 0, 0.9}};
  task.end.turnings = {{Machine::of_box, 0, 0.1}};
  task.end.velocities = {{2, 0, 0.2}, {2, 1, 0}};
  task.duration_is_free = true;
  task.duration_weight = 1;
  task.duration = 0.7;
  task.stages = 4;
  return task;
}

void expect_derivatives(const SceneControl& task) {
  ControlledScene scene(task);
  using Coordinates = SceneTranscription::Coordinates;
  for (const Coordinates coordinates : {Coordinates::along_joints, Coordinates::straight}) {
    SceneTranscription bent(scene, scene_guess(scene, 3), coordinates);
    const laws::LawReport report = laws::transcription_laws(bent, 2);
    EXPECT_TRUE(report.holds()) << report;
  }
}

TEST(ControlledBodies, FreeOnesHaveTheDerivativesOfTheirValues) { expect_derivatives(free_bodies()); }
TEST(ControlledBodies, JointsHaveTheDerivativesOfTheirValues) { expect_derivatives(machine(Retraction::exponential)); }
TEST(ControlledBodies, TurnsByCayleyHaveTheDerivativesOfTheirValues) {
  expect_derivatives(machine(Retraction::cayley));
}
TEST(ControlledBodies, DampedOnesHaveTheDerivativesOfTheirValues) {
  expect_derivatives(machine<DampedMachine>(Retraction::exponential));
  expect_derivatives(machine<DampedMachine>(Retraction::cayley));
}

template <class Written> SceneControl planar() {
  SceneControl task = control_of_scene(Written{});
  task.actuators = {{"shoulder"}, {"elbow"}};
  task.keep_outs = {{Arm::of_fore, KeepOut::Kind::disk, {0.9, 0.9, 0}, 0.3}};
  task.speed_limits = {{.linear = 1, .axes = {0, 1}, .most = 2},
                       {.linear = 0, .axes = {2}, .most = 1},
                       {.site = Arm::of_fore, .most = 3}};
  task.end.places = {{Arm::of_fore, 0, 0.3}, {Arm::of_fore, 1, 0.7}};
  task.stages = 4;
  return task;
}

TEST(ControlledBodies, PlanarOnesHaveTheDerivativesOfTheirValues) {
  expect_derivatives(planar<Arm>());
  expect_derivatives(planar<DampedArm>());
}

/// By how much the motion of the scene without controls misses the equations of the stages. Reactions are impulses of
/// the same rows in both.
double miss_of_the_scenes_steps(const SceneControl& task) {
  ControlledScene scene(task);
  const auto drift = scene.drift(task.stages);
  if (!drift) return HUGE_VAL;
  ScenePath path{*drift, StageRows(task.stages, scene.actuators() + scene.joints()),
                 task.duration / double(task.stages)};
  Multibody motion(task.scene(), path.step);
  motion.switch_to(scene.motion().switches().on);
  const auto& rows = motion.model().rows;
  for (long k = 0; k < task.stages; ++k) {
    EXPECT_TRUE(motion.advance().converged());
    double* reaction = path.controls[k] + scene.actuators();
    for (std::size_t row = 0; row < rows.roles.size(); ++row)
      if (rows.roles[row] == multibody::Role::holonomic && !rows.left_out[row]) *reaction++ = motion.multipliers()[row];
  }
  const SceneTranscription transcription(scene, path);
  StageValues at(transcription.sizes());
  transcription.values(at);
  double most = 0;
  for (long k = 0; k + 1 < task.stages; ++k)
    for (int i = 0; i < transcription.sizes().equalities_of(k); ++i) most = std::max(most, std::abs(at.equality[k][i]));
  return most;
}

TEST(ControlledBodies, WithoutControlsMakeTheStepsOfTheScene) {
  for (const Retraction rotation : {Retraction::exponential, Retraction::cayley}) {
    SceneControl task = machine(rotation);
    task.stages = 20;
    EXPECT_LE(miss_of_the_scenes_steps(task), 1e-12);
    task = machine<DampedMachine>(rotation);
    task.stages = 20;
    EXPECT_LE(miss_of_the_scenes_steps(task), 1e-12);
  }
}

/// A subject whose forces are not those of its scene over numbers with derivatives.
TEST(BrokenControlledBodies, AnotherForceFailsTheLawsOfDerivatives) {
  SceneControl task = control_of_scene(HingedBar{});
  task.second = [] { return HingedBar{2.1}.operator()<SecondNumber>(); };
  task.actuators = {{"motor"}};
  task.duration_is_free = true;
  task.duration_weight = 1;
  task.stages = 4;
  ControlledScene scene(task);
  SceneTranscription bent(scene, scene_guess(scene, 3));
  EXPECT_FALSE(laws::transcription_laws(bent, 1).holds());
}

/// One whose dampers are not those of its scene over numbers with derivatives.
TEST(BrokenControlledBodies, AnotherDamperFailsTheLawsOfDerivatives) {
  SceneControl task = machine<DampedMachine>(Retraction::exponential);
  task.second = [] { return DampedMachine{Retraction::exponential, 0.8}.operator()<SecondNumber>(); };
  ControlledScene scene(task);
  SceneTranscription bent(scene, scene_guess(scene, 3));
  EXPECT_FALSE(laws::transcription_laws(bent, 1).holds());
}

}  // namespace
}  // namespace lagroid::controlled_bodies_derivatives_tests
