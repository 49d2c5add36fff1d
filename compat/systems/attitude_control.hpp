#pragma once
/// Moved to <lagroid/systems/control/attitude_control.hpp>; this goes with version 0.4.

#include <lagroid/systems/control/attitude_control.hpp>
