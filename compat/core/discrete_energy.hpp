#pragma once
/// Moved to <lagroid/core/capabilities/discrete_energy.hpp>; this goes with version 0.4.

#include <lagroid/core/capabilities/discrete_energy.hpp>
