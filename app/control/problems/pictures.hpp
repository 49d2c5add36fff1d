#pragma once
/// How problems of control look, where runs of such a motion have a picture: by the names of their states.
///
///     static const ControlProblemOf<DubinsCar> problem("dubins_car", "...", [](const DubinsCar&) { return a_car(); });

#include <lagroid/run/motion/shape.hpp>

#include <utility>
#include <vector>

namespace lagroid::app {

/// At the states x, y and this height, turned about the vertical by the state `angle`.
inline Shape in_the_plane(Shape shape, double height) {
  shape = on_the_plane(std::move(shape), height);
  shape.turns.front().angle = "angle";
  return shape;
}

/// A body of these sides, longest ahead, with the line that its centre draws.
inline std::vector<Shape> a_car() {
  Shape car = in_the_plane({"box", {0.4, 0.2, 0.1}}, 0.05);
  car.trail = true;
  return {car};
}

}  // namespace lagroid::app
