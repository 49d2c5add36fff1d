#pragma once
/// Moved to <lagroid/solvers/newton/ceres_manifold.hpp>; this goes with version 0.4.

#include <lagroid/solvers/newton/ceres_manifold.hpp>

namespace lagroid {

template <Groupoid G>
using AlphaFibreManifold [[deprecated("AlphaFibreManifold is SourceFibreManifold")]] = SourceFibreManifold<G>;

}  // namespace lagroid
