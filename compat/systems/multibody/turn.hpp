#pragma once
/// Moved to <lagroid/systems/multibody/rotation_increment.hpp>; this goes with version 0.4.

#include <lagroid/systems/multibody/rotation_increment.hpp>
