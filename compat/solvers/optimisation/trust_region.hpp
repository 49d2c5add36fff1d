#pragma once
/// Moved to <lagroid/solvers/optimisation/methods/trust_region.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/solvers/optimisation/minimise_names.hpp>
