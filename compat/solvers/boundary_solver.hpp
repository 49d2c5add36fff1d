#pragma once
/// Moved to <lagroid/solvers/boundary/boundary_solver.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/boundary_solver.hpp>

namespace lagroid {

using Seek [[deprecated("Seek is StationaryKind")]] = StationaryKind;
template <DiscreteSystem Sys>
[[deprecated("natural_seek is natural_stationary_kind")]] inline constexpr StationaryKind natural_seek =
    natural_stationary_kind<Sys>;

}  // namespace lagroid
