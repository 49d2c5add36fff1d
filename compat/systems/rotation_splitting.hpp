#pragma once
/// Moved to <lagroid/systems/rotations/rotation_splitting.hpp>; this goes with version 0.4.

#include <lagroid/systems/rotations/rotation_splitting.hpp>
