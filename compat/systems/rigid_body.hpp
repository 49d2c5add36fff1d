#pragma once
/// Moved to <lagroid/systems/rotations/rigid_body.hpp>; this goes with version 0.4.

#include <lagroid/systems/rotations/rigid_body.hpp>
