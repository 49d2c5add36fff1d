#pragma once
/// Moved to <lagroid/solvers/optimisation/manifolds/manifold.hpp>; this goes with version 0.4.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

namespace lagroid::optimisation {

using Retraction [[deprecated("Retraction is ManifoldRetraction")]] = ManifoldRetraction;

}  // namespace lagroid::optimisation
