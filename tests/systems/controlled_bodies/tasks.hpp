// Problems of these scenes that tests share.
#pragma once

#include "scenes.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace lagroid::controlled_bodies_tests {

/// At rest at these places (x, y, angle) of planar bodies, each with its number.
inline SceneEnd at_rest(const std::vector<std::pair<Site, Vec>>& places) {
  SceneEnd out;
  int body = 0;
  for (const auto& [site, place] : places) {
    for (int i = 0; i < 3; ++i) {
      out.places.push_back({site, i, place(i)});
      out.velocities.push_back({body, i, 0});
    }
    ++body;
  }
  return out;
}

/// The arm from (a, b) = (0, 0.3) to (1.6, 0.3), at rest at both ends.
template <class Written> SceneControl reach_of(double radius) {
  SceneControl task = control_of_scene(Written{});
  task.actuators = {{"shoulder"}, {"elbow"}};
  task.duration = 2;
  const Vec elbow(std::cos(1.6), std::sin(1.6), 0);
  const Vec along(std::cos(1.9), std::sin(1.9), 0);
  Vec upper = 0.5 * elbow, fore = elbow + 0.5 * along;
  upper(2) = 1.6;
  fore(2) = 1.9;
  task.end = at_rest({{Arm::of_upper, upper}, {Arm::of_fore, fore}});
  if (radius > 0)
    for (const int site : Arm::of_points) task.keep_outs.push_back({{site}, KeepOut::Kind::disk, {1, 1, 0}, radius});
  return task;
}

inline SceneControl reach(double radius) { return reach_of<Arm>(radius); }

/// The cat that turns about its length, at rest in the end: both halves, which is more than the motion leaves free.
inline SceneControl turning_cat(double angle, const Cat& cat = {}) {
  SceneControl task = control_of_scene(cat);
  task.actuators = {{"pitch"}, {"roll"}, {"twist"}};
  const Quaternion turned(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
  task.end.turns = {{Cat::of_front, turned}, {Cat::of_rear, turned}};
  for (int body = 0; body < 2; ++body)
    for (int i = 0; i < 3; ++i) {
      task.end.turnings.push_back({{body}, i, 0});
      task.end.velocities.push_back({body, i, 0});
    }
  return task;
}

}  // namespace lagroid::controlled_bodies_tests
