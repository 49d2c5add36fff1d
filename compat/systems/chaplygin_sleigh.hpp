#pragma once
/// Moved to <lagroid/systems/rolling/chaplygin_sleigh.hpp>; this goes with version 0.4.

#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
