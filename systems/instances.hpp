#pragma once
/// The templates of core and solvers for a system, compiled once.
///
/// A system's header ends with LAGROID_STEPS(extern template, Sys) and LAGROID_SOLVERS(extern template, Sys); files
/// that the build makes (systems/systems.cmake) hold them without `extern`, all in namespace lagroid. A system of your
/// own needs neither: its templates are compiled where they are used. A forced or nonholonomic system, which has no
/// action whose critical points the boundary solvers would look for, has LAGROID_STEP_SOLVERS in place of
/// LAGROID_SOLVERS, and so does one that depends on time.

#include <lagroid/core/any_system/any_system_of.hpp>
#include <lagroid/core/derivatives/second_derivatives.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#define LAGROID_STEP_CLASSES(prefix, Sys)  \
  prefix class NewtonStep<Sys>;            \
  prefix class StepPredictor<Sys>;         \
  prefix class CompensatedTrajectory<Sys>; \
  prefix class FixedStepIntegrator<Sys>

#define LAGROID_STEPS(prefix, Sys)                                                                                     \
  prefix GradientsOf<Sys> automatic_gradients(const Sys&, const ArrowOf<Sys::GroupoidType>&, const Sys::Multipliers&); \
  prefix TwoSidedOf<Sys> automatic_two_sided(const Sys&, const ArrowOf<Sys::GroupoidType>&, const Sys::Multipliers&);  \
  LAGROID_STEP_CLASSES(prefix, Sys)

#define LAGROID_STEP_SOLVERS(prefix, Sys)                                                                        \
  prefix std::unique_ptr<StepSolver<Sys>> make_step_solver(const Sys&, StepMethod, StepOptions);                 \
  prefix std::unique_ptr<Integrator<Sys>> make_integrator(                                                       \
      const Sys&, const State<Sys::GroupoidType>&, const ArrowOf<Sys::GroupoidType>&, const IntegratorOptions&); \
  prefix double step_for_accuracy(const Sys&, const State<Sys::GroupoidType>&, double, const IntegratorOptions&)

/// What adaptive steps of a system are made of, in a file of their own: they solve for one unknown more.
#define LAGROID_ADAPTIVE_STEPS(prefix, Sys)                                                                          \
  prefix std::unique_ptr<StepSolver<FreeTime<Sys>>> make_step_solver(const FreeTime<Sys>&, StepMethod, StepOptions); \
  prefix class AdaptiveIntegrator<Sys>

#define LAGROID_BOUNDARY_VALUES(prefix, Sys)                                                                         \
  prefix SecondDerivativesOf<Sys> second_derivatives(const Sys&, const ArrowOf<Sys::GroupoidType>&,                  \
                                                     const Sys::Multipliers&);                                       \
  prefix class AnySystemOf<Sys>;                                                                                     \
  prefix std::unique_ptr<BoundarySolver<Sys>> make_boundary_solver(BoundaryMethod, BoundaryOptions, StationaryKind); \
  prefix MultistartResult<Sys> solve_boundary(const BoundarySolver<Sys>&, const BoundaryProblem<Sys>&, std::size_t,  \
                                              const MultistartOptions&)

#define LAGROID_SOLVERS(prefix, Sys) \
  LAGROID_STEP_SOLVERS(prefix, Sys); \
  LAGROID_BOUNDARY_VALUES(prefix, Sys)
