#pragma once
/// Attitudes between scenes (quaternions) and systems (rotation matrices).

#include "../scene_reader.hpp"

#include <lagroid/groupoids/so3.hpp>

#include <array>

namespace lagroid::app {

inline Matrix<double, 3, 3> rotation_from(const std::array<double, 4>& q) {
  return SO3::from_quaternion({q[0], q[1], q[2], q[3]});
}
/// The rotation a table's `attitude` gives, the identity by default.
inline Matrix<double, 3, 3> read_rotation(const Section& section) {
  return rotation_from(section.has("attitude") ? section.attitude("attitude") : std::array<double, 4>{1, 0, 0, 0});
}
inline std::array<double, 4> quaternion_of(const Matrix<double, 3, 3>& rotation) {
  const auto q = SO3::quaternion(rotation);
  return {q(0), q(1), q(2), q(3)};
}

}  // namespace lagroid::app
