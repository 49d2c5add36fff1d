#pragma once
/// Moved to <lagroid/systems/rotations/lie_poisson.hpp>; this goes with version 0.4.

#include <lagroid/systems/rotations/lie_poisson.hpp>
