#pragma once
/// Moved to <lagroid/solvers/optimisation/manifolds/stiefel.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
