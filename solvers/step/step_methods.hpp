#pragma once
/// Defines the solvers of a step by their names (StepMethod): what `make_step_solver` makes. Include it for a system of
/// your own; those of systems/ are compiled in the library.

#ifdef LAGROID_WITHOUT_CERES
#include <lagroid/solvers/missing_library.hpp>
#else
#include <lagroid/solvers/step/ceres_step.hpp>
#endif
#include <lagroid/solvers/step/newton_step.hpp>

namespace lagroid {

template <DiscreteSystem Sys> struct detail::StepSolvers {
  static std::unique_ptr<StepSolver<Sys>> make([[maybe_unused]] const Sys& system, StepMethod method,
                                               StepOptions options) {
    if (method == StepMethod::ceres) {
#ifdef LAGROID_WITHOUT_CERES
      throw MissingLibrary("the solver \"ceres\" of a step", "Ceres", "libceres-dev");
#else
      const int iterations = options.max_iterations > 0 ? options.max_iterations : 100;
      return std::make_unique<CeresStep<Sys>>(iterations, options.tolerance, system.groupoid);
#endif
    }
    NewtonOptions newton;
    if (options.max_iterations > 0) newton.max_iterations = options.max_iterations;
    newton.tolerance = options.tolerance;
    return std::make_unique<NewtonStep<Sys>>(newton);
  }
};

}  // namespace lagroid
