#pragma once
/// Moved to <lagroid/solvers/boundary/continuation.hpp>; this goes with version 0.4.

#include <lagroid/solvers/boundary/continuation.hpp>

namespace lagroid {

template <DiscreteSystem Sys>
[[deprecated("carry is continue_to")]] BoundarySolution<Sys> carry(const BoundarySolver<Sys>& solver,
                                                                   const BoundaryStage<Sys>& stage,
                                                                   const BoundarySolution<Sys>& from,
                                                                   const Path<Sys>& prediction) {
  return continue_to(solver, stage, from, prediction);
}

}  // namespace lagroid
