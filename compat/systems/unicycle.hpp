#pragma once
/// Moved to <lagroid/systems/control/unicycle.hpp>; this goes with version 0.4.

#include <lagroid/systems/control/unicycle.hpp>
