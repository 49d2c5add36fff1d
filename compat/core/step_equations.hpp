#pragma once
/// Moved to <lagroid/core/derivatives/step_equations.hpp>; this goes with version 0.4.

#include <lagroid/core/derivatives/step_equations.hpp>
