// What cannot be controlled is refused in one line that says why.
#include "scenes.hpp"

#include <lagroid/systems/multibody/control/controlled_scene.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace lagroid::controlled_bodies_refusals_tests {
namespace {

using namespace controlled_bodies_tests;

void expect_refused(const std::function<void(SceneControl&)>& spoil, const std::string& why) {
  SceneControl task = control_of_scene(HingedBar{});
  task.actuators = {{"motor", -1, 1}};
  task.stages = 4;
  EXPECT_NO_THROW(ControlledScene{task});
  spoil(task);
  try {
    const ControlledScene scene(task);
    ADD_FAILURE() << "not refused: " << why;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

/// The hinged bar with something more, which the lambda adds to it: more.operator()<S>(scene).
template <class More> auto with(const More& more) {
  return [more](SceneControl& task) {
    const auto write = [more]<class S>() {
      BasicScene<S> scene = HingedBar{}.operator()<S>();
      more(scene);
      return scene;
    };
    const std::vector<Actuator> actuators = task.actuators;
    task = control_of_scene(write);
    task.actuators = actuators;
  };
}

TEST(ControlledBodies, WhatCannotBeControlledIsRefused) {
  expect_refused([](auto& task) { task.actuators[0].effect = "engine"; }, "there is no effect \"engine\"");
  expect_refused([](auto& task) { task.actuators.push_back({"motor"}); }, "controlled twice");
  expect_refused([](auto& task) { task.actuators.clear(); }, "nothing is controlled");
  expect_refused([](auto& task) { task.actuators[0].upper = -1; }, "is not below its upper bound");
  expect_refused([](auto& task) { task.actuators[0].weight = 0; }, "nothing costs");
  expect_refused([](auto& task) { task.actuators[0].weight = -1; }, "is negative");
  expect_refused([](auto& task) { task.duration_is_free = true; }, "may grow for ever");
  expect_refused([](auto& task) { task.duration = 0; }, "is not positive");
  expect_refused([](auto& task) { task.stages = 1; }, "at least two");
  expect_refused([](auto& task) { task.end.places = {{HingedBar::of_bar, 0, 0.7}}; }, "do not reach the end");
  expect_refused(
      [](auto& task) {
        task.end.places = {{HingedBar::of_bar, 2, 0}};
        task.end.velocities = {{0, 0, 1}};
      },
      "do not allow the velocities");
  expect_refused(
      [](auto& task) {
        task.keep_outs = {{HingedBar::of_bar, KeepOut::Kind::sphere, {0.5, 0, 0}, 0.1}};
      },
      "keep-out 1 does not hold at the start");
  expect_refused([](auto& task) { task.speed_limits = {{.linear = 0, .axes = {3}}}; }, "name axes of 0, 1 and 2");
  expect_refused([](auto& task) { task.speed_limits = {{.linear = 0, .most = 0}}; }, "0 is not positive");
  expect_refused([](auto& task) { task.speed_limits = {{.most = 1}}; }, "name a centre or an attitude");
  expect_refused([](auto& task) { task.cones = {DirectionCone()}; }, "name the attitude of a body");
  const auto damped_by_name = []<class S>(BasicScene<S>& scene) {
    scene.begin_switch("brake");
    scene.add(Damper<BasicLength<S>, S>{BasicLength<S>{{scene.ground(vec<S>(2, 1, 0)), HingedBar::of_bar}}, S(1)});
    scene.end_switch();
  };
  expect_refused(
      [&](auto& task) {
        task.actuators = {{"brake", -1, 1}};
        with(damped_by_name)(task);
      },
      "\"brake\" is a damper");
  expect_refused(with([]<class S>(BasicScene<S>& scene) { scene.add(BasicBlade<S>{{HingedBar::of_bar}}); }),
                 "joints on velocities");
}

TEST(ControlledBodies, ConesThatAreNoneAreRefused) {
  SceneControl task = control_of_scene(Satellite{});
  task.actuators = {{"torque1"}};
  task.stages = 4;
  const auto refused = [&](const DirectionCone& cone, const std::string& why) {
    task.cones = {cone};
    try {
      const ControlledScene scene(task);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  const DirectionCone good{Satellite::of_body, {0, 0, 1}, {1, 0, 0}, 1, DirectionCone::Side::outside};
  task.cones = {good};
  EXPECT_NO_THROW(ControlledScene{task});
  DirectionCone bad = good;
  bad.angle = 1.6;
  refused(bad, "cone 1 does not hold at the start");
  bad.angle = 3.2;
  refused(bad, "3.2 is not between zero and pi");
  bad = good;
  bad.direction.setZero();
  refused(bad, "the length one");
  bad = good;
  bad.side = DirectionCone::Side::inside;
  refused(bad, "cone 1 does not hold at the start");
}

// Of an end, too, that nothing outside can bring about.
TEST(ControlledBodies, AnotherMomentumThanTheMotionKeepsIsRefused) {
  SceneControl task = control_of_scene(Cat{});
  task.actuators = {{"pitch"}, {"roll"}, {"twist"}};
  for (int body = 0; body < 2; ++body) task.end.velocities.push_back({body, 0, 0});
  EXPECT_NO_THROW(ControlledScene{task});
  for (SceneEnd::Velocity& each : task.end.velocities) each.value = 1;
  EXPECT_THROW(ControlledScene{task}, std::invalid_argument);
  task.end.velocities.clear();
  for (const int body : {0, 1}) task.end.places.push_back({{body}, 0, 0.2});
  EXPECT_THROW(ControlledScene{task}, std::invalid_argument);
}

/// A mass in a magnetic field along no axis, pushed across it.
struct MassInField {
  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const Body mass = scene.point_mass(S(1), vec<S>(0, 0, 0), vec<S>(0, 0, 0));
    scene.gyroscopic_force(mass, vec<S>(1, 1, 1));
    scene.begin_switch("push");
    scene.add(BasicConstantForce<S>{{mass.centre}, vec<S>(1, -1, 0)});
    scene.end_switch();
    return scene;
  }
};
TEST(ControlledBodies, AlongAMagneticFieldTheCentreOfMassIsHeld) {
  SceneControl task = control_of_scene(MassInField{});
  task.actuators = {{"push"}};
  const auto ends_at = [&](double x) {
    task.end.places.clear();
    for (int axis = 0; axis < 3; ++axis) task.end.places.push_back({{0}, axis, x});
  };
  ends_at(0);
  EXPECT_NO_THROW(ControlledScene{task});
  ends_at(0.5);
  EXPECT_THROW(ControlledScene{task}, std::invalid_argument);
}

/// A mass in space that a force pushes along the first axis.
struct PushedMass {
  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const Body mass = scene.point_mass(S(1), vec<S>(0, 0, 0), vec<S>(0, 0, 0));
    scene.begin_switch("push");
    scene.add(BasicConstantForce<S>{{mass.centre}, vec<S>(1, 0, 0)});
    scene.end_switch();
    return scene;
  }
};
TEST(ControlledBodies, AnEndIsFoundAtAnyDistance) {
  SceneControl task = control_of_scene(PushedMass{});
  task.actuators = {{"push"}};
  for (const double distance : {1.0, 1e3, 1e6, 1e9}) {
    task.end.places = {{{0}, 0, distance}};
    EXPECT_NO_THROW(ControlledScene{task}) << distance;
  }
}

TEST(ControlledBodies, EndsBeyondTheirLimitsAreRefused) {
  SceneControl task = control_of_scene(Cat{});
  task.actuators = {{"pitch"}, {"roll"}, {"twist"}};
  task.speed_limits = {{.attitude = Attitude{0}, .most = 2}};
  task.end.turnings = {{Attitude{0}, 0, 1.5}};
  EXPECT_NO_THROW(ControlledScene{task});
  task.end.turnings.push_back({Attitude{0}, 1, 1.5});
  EXPECT_THROW(ControlledScene{task}, std::invalid_argument);
  task.end.turnings.clear();
  task.end.turns = {{Attitude{0}, {0, 1, 0, 0}}};
  task.cones = {{.attitude = Attitude{0}, .angle = 0.5, .side = DirectionCone::Side::inside}};
  EXPECT_THROW(ControlledScene{task}, std::invalid_argument);
  task.cones.front().side = DirectionCone::Side::outside;
  task.cones.front().axis = Vec::UnitX();
  EXPECT_NO_THROW(ControlledScene{task});
}

}  // namespace
}  // namespace lagroid::controlled_bodies_refusals_tests
