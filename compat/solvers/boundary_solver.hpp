#pragma once
/// Moved to <lagroid/solvers/boundary/boundary_solver.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/boundary_solver.hpp>

namespace lagroid {

using Seek [[deprecated("Seek is StationaryKind")]] = StationaryKind;

}  // namespace lagroid
