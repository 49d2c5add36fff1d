#pragma once
/// The names of the solvers of boundary values in scenes and Python: newton, shooting, ceres; the first is the default.
///
///     const BoundaryMethod method = choice_of(boundary_words, "shooting");  // throws std::invalid_argument for others

#include <lagroid/solvers/boundary/boundary_solver.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <array>

namespace lagroid {

/// [solver] method of a boundary value, and Python's; the first is the default.
inline constexpr std::array<Word<BoundaryMethod>, 3> boundary_words{
    {{"newton", BoundaryMethod::newton}, {"shooting", BoundaryMethod::shooting}, {"ceres", BoundaryMethod::ceres}}};

}  // namespace lagroid
