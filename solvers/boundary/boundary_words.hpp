#pragma once
/// What the solvers of boundary values are called.

#include <lagroid/solvers/boundary/boundary_solver.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <array>

namespace lagroid {

/// [solver] method of a boundary value, and Python's; the first is the default.
inline constexpr std::array<Word<BoundaryMethod>, 3> boundary_words{
    {{"newton", BoundaryMethod::newton}, {"shooting", BoundaryMethod::shooting}, {"ceres", BoundaryMethod::ceres}}};

}  // namespace lagroid
