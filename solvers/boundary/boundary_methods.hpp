#pragma once
/// Defines the solvers of boundary values by their names (BoundaryMethod), and their search, for systems of any sizes.
/// Include it where the library has not the sizes of your system; the compiler's message names it then. In a build
/// without Ceres `make_boundary_solver(BoundaryMethod::ceres)` throws MissingLibrary.

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
                                                     StationaryKind kind) {
    switch (method) {
      case BoundaryMethod::shooting:
        return std::make_unique<BoundaryShooting<Sized>>(options, kind);
      case BoundaryMethod::ceres:
#ifdef LAGROID_WITHOUT_CERES
        throw MissingLibrary("the solver \"ceres\" of boundary values", "Ceres", "libceres-dev");
#else
        return std::make_unique<BoundaryCeres<Sized>>(options, kind);
#endif
      default:
        return std::make_unique<BoundaryNewton<Sized>>(options, kind);
    }
  }
};

template <DiscreteSystem Sized>
std::unique_ptr<BoundarySolver<Sized>> make_sized_boundary_solver(BoundaryMethod method, BoundaryOptions options,
                                                                  StationaryKind kind) {
  return BoundarySolvers<Sized>::make(method, options, kind);
}

}  // namespace lagroid::detail
