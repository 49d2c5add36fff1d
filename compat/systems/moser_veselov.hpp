#pragma once
/// Moved to <lagroid/systems/rotations/moser_veselov.hpp>; this goes with version 0.4.

#include <lagroid/systems/rotations/moser_veselov.hpp>
