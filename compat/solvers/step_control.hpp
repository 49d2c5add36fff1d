#pragma once
/// Moved to <lagroid/solvers/integrators/step_control.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/step_control.hpp>
