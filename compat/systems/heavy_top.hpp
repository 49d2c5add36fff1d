#pragma once
/// Moved to <lagroid/systems/rotations/heavy_top.hpp>; this goes with version 0.4.

#include <lagroid/systems/rotations/heavy_top.hpp>
