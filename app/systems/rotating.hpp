#pragma once
/// What scenes say of bodies that turn about a fixed point.

#include "attitude.hpp"
#include "group_map.hpp"

#include <lagroid/systems/rotation_map.hpp>

#include <fmt/format.h>

#include <string_view>

namespace lagroid::app {

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
/// `rotation`: exp, which is the default, or cayley.
inline RotationMap read_rotation_map(const Section& parameters) { return read_group_map(parameters, "rotation"); }

}  // namespace lagroid::app
