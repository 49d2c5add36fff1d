#pragma once
/// Moved to <lagroid/systems/rolling/rolling_ball.hpp>; this goes with version 0.4.

#include <lagroid/systems/rolling/rolling_ball.hpp>
