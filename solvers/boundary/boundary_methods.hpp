#pragma once
/// Solvers of a boundary-value problem by name, and the search of its solutions, for systems of any sizes.

#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/solvers/boundary/boundary_shooting.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>
#ifdef LAGROID_WITHOUT_CERES
#include <lagroid/solvers/missing_library.hpp>
#else
#include <lagroid/solvers/boundary/boundary_ceres.hpp>
#endif

namespace lagroid::detail {

template <DiscreteSystem Sized> struct BoundarySolvers {
  static std::unique_ptr<BoundarySolver<Sized>> make(BoundaryMethod method, BoundaryOptions options,
                                                     StationaryKind seek) {
    switch (method) {
      case BoundaryMethod::shooting:
        return std::make_unique<BoundaryShooting<Sized>>(options, seek);
      case BoundaryMethod::ceres:
#ifdef LAGROID_WITHOUT_CERES
        throw MissingLibrary("the solver \"ceres\" of boundary values", "Ceres", "libceres-dev");
#else
        return std::make_unique<BoundaryCeres<Sized>>(options, seek);
#endif
      default:
        return std::make_unique<BoundaryNewton<Sized>>(options, seek);
    }
  }
};

template <DiscreteSystem Sized>
std::unique_ptr<BoundarySolver<Sized>> make_sized_boundary_solver(BoundaryMethod method, BoundaryOptions options,
                                                                  StationaryKind seek) {
  return BoundarySolvers<Sized>::make(method, options, seek);
}

}  // namespace lagroid::detail
