#pragma once
/// Moved to <lagroid/systems/multibody/rotation_increment.hpp>; this goes with version 0.4.

#include <lagroid/systems/multibody/rotation_increment.hpp>

namespace lagroid::multibody {

using Turn [[deprecated("Turn is RotationIncrement")]] = RotationIncrement;

}  // namespace lagroid::multibody
