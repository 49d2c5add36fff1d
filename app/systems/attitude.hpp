#pragma once
/// Attitudes between scenes (quaternions) and systems (rotation matrices), and the moments of what turns.

#include "../reading/scene_reader.hpp"

#include <lagroid/groupoids/so3.hpp>
#include <lagroid/run/run_result.hpp>

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

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

/// Three positive numbers; `meaning` names them in messages.
inline Vector<double, 3> read_positive(const Section& parameters, std::string_view key, std::string_view meaning) {
  const auto values = parameters.numbers(key, 3, meaning);
  for (const double value : values)
    if (!(value > 0)) parameters.fail(key, fmt::format("{} must be positive, got {}", meaning, value));
  return Eigen::Map<const Vector<double, 3>>(values.data());
}
/// `inertia`: three positive principal moments.
inline Vector<double, 3> read_inertia(const Section& parameters) {
  return read_positive(parameters, "inertia", "principal moments");
}

/// The attitude over time.
inline Panel attitude_panel(const std::vector<std::string>& quaternion = attitude_columns,
                            const std::string& title = "attitude") {
  return {title + ", unit quaternion", "t", "w, x, y, z", "t", quaternion};
}

}  // namespace lagroid::app
