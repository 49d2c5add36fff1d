#pragma once
/// Moved to <lagroid/systems/control/plate_ball.hpp>; this goes with version 0.4.

#include <lagroid/systems/control/plate_ball.hpp>
