#pragma once
/// Moved to <lagroid/solvers/integrators/runge_kutta.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/runge_kutta.hpp>
