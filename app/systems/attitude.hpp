#pragma once
/// Attitudes between scenes (quaternions) and systems (rotation matrices).

#include <lagroid/groupoids/so3.hpp>

#include <array>

namespace lagroid::app {

inline Matrix<double, 3, 3> rotation_from(const std::array<double, 4>& q) {
  return SO3::from_quaternion({q[0], q[1], q[2], q[3]});
}
inline std::array<double, 4> quaternion_of(const Matrix<double, 3, 3>& rotation) {
  const auto q = SO3::quaternion(rotation);
  return {q(0), q(1), q(2), q(3)};
}

}  // namespace lagroid::app
