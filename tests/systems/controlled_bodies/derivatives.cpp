// Derivatives of controlled scenes of bodies are those of their values, and without controls their steps are those of
// the simulation.
#include "scenes.hpp"

#include <lagroid/solvers/testing/control_laws.hpp>
#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <gtest/gtest.h>

namespace lagroid {
namespace {

using namespace controlled_bodies_tests;
using multibody::Vec;

SceneControl free_bodies() {
  SceneControl task = control_of_scene(FreeBodies{});
  task.actuators = {{"torque", -1, 1, 0.7}, {"force", -HUGE_VAL, 2}};
  task.keep_outs = {{FreeBodies::of_corner, KeepOut::Kind::sphere, {0.5, 0.5, 0.5}, 0.2},
                    {FreeBodies::of_bob, KeepOut::Kind::plane, {0, 0, -1}, 1, {0.6, 0, 0.8}},
                    {FreeBodies::of_corner, KeepOut::Kind::disk, {-0.5, 0.5, 0}, 0.3}};
  task.end.places = {{FreeBodies::of_corner, 0, 0.5}, {FreeBodies::of_bob, 2, 0.1}};
  task.end.turns = {{FreeBodies::of_box, Quaternion(0.8, 0.6, 0, 0)}};
  task.end.velocities = {{0, 1, 0.3}};
  task.end.turnings = {{FreeBodies::of_box, 2, 0.4}};
  task.duration_is_free = true;
  task.duration_weight = 0.3;
  task.stages = 4;
  return task;
}

SceneControl machine(Retraction rotation) {
  SceneControl task = control_of_scene(Machine{rotation});
  task.actuators = {{"rail"}, {"joint", -1, 1}};
  task.keep_outs = {{Machine::of_bob, KeepOut::Kind::sphere, {1.5, 0.5, -0.5}, 0.2}};
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
  SceneTranscription bent(scene, scene_guess(scene, 3));
  const laws::LawReport report = laws::transcription_laws(bent, 2);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(ControlledBodies, FreeOnesHaveTheDerivativesOfTheirValues) { expect_derivatives(free_bodies()); }
TEST(ControlledBodies, JointsHaveTheDerivativesOfTheirValues) { expect_derivatives(machine(Retraction::exponential)); }
TEST(ControlledBodies, TurnsByCayleyHaveTheDerivativesOfTheirValues) {
  expect_derivatives(machine(Retraction::cayley));
}
TEST(ControlledBodies, PlanarOnesHaveTheDerivativesOfTheirValues) {
  SceneControl task = control_of_scene(Arm{});
  task.actuators = {{"shoulder"}, {"elbow"}};
  task.keep_outs = {{Arm::of_fore, KeepOut::Kind::disk, {0.9, 0.9, 0}, 0.3}};
  task.end.places = {{Arm::of_fore, 0, 0.3}, {Arm::of_fore, 1, 0.7}};
  task.stages = 4;
  expect_derivatives(task);
}

// Reactions are impulses of the same rows in both.
TEST(ControlledBodies, WithoutControlsMakeTheStepsOfTheScene) {
  for (const Retraction rotation : {Retraction::exponential, Retraction::cayley}) {
    SceneControl task = machine(rotation);
    task.stages = 20;
    ControlledScene scene(task);
    const auto drift = scene.drift(20);
    ASSERT_TRUE(drift);
    ScenePath path{*drift, StageRows(20, scene.actuators() + scene.joints()), task.duration / 20};
    Multibody motion(task.scene(), path.step);
    motion.switch_to(scene.motion().switches().on);
    for (long k = 0; k < 20; ++k) {
      ASSERT_TRUE(motion.advance().converged());
      for (int row = 0; row < scene.joints(); ++row)
        path.controls[k][scene.actuators() + row] = motion.multipliers()[std::size_t(row)];
    }
    const SceneTranscription transcription(scene, path);
    StageValues at(transcription.sizes());
    transcription.values(at);
    double most = 0;
    for (long k = 0; k < 19; ++k)
      for (int i = 0; i < transcription.sizes().equalities_of(k); ++i)
        most = std::max(most, std::abs(at.equality[k][i]));
    EXPECT_LE(most, 1e-12);
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

}  // namespace
}  // namespace lagroid
