#pragma once
/// Moved to <lagroid/solvers/integrators/fixed_step_integrator.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
