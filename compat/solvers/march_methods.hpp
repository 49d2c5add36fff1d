#pragma once
/// Moved to <lagroid/solvers/integrators/integrator_methods.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/integrator_methods.hpp>
