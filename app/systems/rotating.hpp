#pragma once
/// What scenes say of bodies that turn about a fixed point.

#include "attitude.hpp"

#include <lagroid/systems/rotation_map.hpp>

#include <fmt/format.h>

namespace lagroid::app {

/// `inertia`: three positive principal moments.
inline Vector<double, 3> read_inertia(const Section& parameters) {
  const auto inertia = parameters.numbers("inertia", 3, "principal moments");
  for (const double moment : inertia)
    if (!(moment > 0)) parameters.fail("inertia", fmt::format("principal moments must be positive, got {}", moment));
  return Eigen::Map<const Vector<double, 3>>(inertia.data());
}
/// `rotation`: exp, which is the default, or cayley.
inline RotationMap read_rotation_map(const Section& parameters) {
  return parameters.choice_or("rotation", "exp", {"exp", "cayley"}) == "exp" ? RotationMap::exponential
                                                                             : RotationMap::cayley;
}

}  // namespace lagroid::app
