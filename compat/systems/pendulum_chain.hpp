#pragma once
/// Moved to <lagroid/systems/pendulums/pendulum_chain.hpp>; this goes with version 0.4.

#include <lagroid/systems/pendulums/pendulum_chain.hpp>
