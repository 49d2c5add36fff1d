#pragma once
/// Moved to <lagroid/systems/pendulums/chain_trajectories.hpp>; this goes with version 0.4.

#include <lagroid/systems/pendulums/chain_trajectories.hpp>
