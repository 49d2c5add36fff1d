#pragma once
/// Moved to <lagroid/systems/control/rotation_map.hpp>; this goes with version 0.4.

#include <lagroid/systems/control/rotation_map.hpp>
