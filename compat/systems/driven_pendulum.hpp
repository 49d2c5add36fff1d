#pragma once
/// Moved to <lagroid/systems/pendulums/driven_pendulum.hpp>; this goes with version 0.4.

#include <lagroid/systems/pendulums/driven_pendulum.hpp>
