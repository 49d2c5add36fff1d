#pragma once
/// Poses in the plane between scenes and systems.

#include "../reading/scene_reader.hpp"

#include <lagroid/groupoids/se2.hpp>

#include <cmath>
#include <vector>

namespace lagroid::app {

/// `position`: x, y and the heading in radians.
inline Matrix<double, 3, 3> read_pose(const Section& section) {
  const auto pose = section.numbers("position", 3, "x, y, heading");
  return SE2::homogeneous<double>(SO2::exp(Vector<double, 1>(pose[2])), {pose[0], pose[1]});
}
inline std::vector<double> coordinates_of_pose(const Matrix<double, 3, 3>& pose) {
  return {pose(0, 2), pose(1, 2), std::atan2(pose(1, 0), pose(0, 0))};
}

}  // namespace lagroid::app
