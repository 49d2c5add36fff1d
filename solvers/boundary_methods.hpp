#pragma once
/// Solvers of a boundary-value problem by name, and the search of its solutions: all that a system of your own needs.

#include <lagroid/solvers/boundary_ceres.hpp>
#include <lagroid/solvers/boundary_newton.hpp>
#include <lagroid/solvers/boundary_shooting.hpp>
#include <lagroid/solvers/boundary_values.hpp>

namespace lagroid {

template <DiscreteSystem Sys> struct detail::BoundarySolvers {
  static std::unique_ptr<BoundarySolver<Sys>> make(BoundaryMethod method, BoundaryOptions options, Seek seek) {
    switch (method) {
      case BoundaryMethod::shooting:
        return std::make_unique<BoundaryShooting<Sys>>(options, seek);
      case BoundaryMethod::ceres:
        return std::make_unique<BoundaryCeres<Sys>>(options, seek);
      default:
        return std::make_unique<BoundaryNewton<Sys>>(options, seek);
    }
  }
};

}  // namespace lagroid
