#pragma once
/// Moved to <lagroid/systems/pendulums/damped_pendulum.hpp>; this goes with version 0.4.

#include <lagroid/systems/pendulums/damped_pendulum.hpp>
