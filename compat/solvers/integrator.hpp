#pragma once
/// Moved to <lagroid/solvers/integrators/fixed_step_integrator.hpp>, where Integrator is FixedStepIntegrator
/// (Integrator is what March was); this goes with version 0.4.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
