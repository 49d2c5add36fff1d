#pragma once
/// Moved to <lagroid/systems/control/group_control.hpp>; this goes with version 0.4.

#include <lagroid/systems/control/group_control.hpp>
