#pragma once
/// Moved to <lagroid/core/derivatives/directional.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/directional.hpp>
