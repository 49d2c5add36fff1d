#pragma once
/// Moved to <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/minimise_names.hpp>
