#pragma once
/// Moved to <lagroid/solvers/optimisation/methods/gradient_descent.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/minimise_names.hpp>
