#pragma once
/// The one-step map on A*G: (q, mu) -> g -> (q', mu').

#include <lagroid/core/stepped.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/method.hpp>
#include <lagroid/solvers/stepper.hpp>
#include <lagroid/solvers/walk.hpp>

#include <memory>
#include <utility>

namespace lagroid {

/// Marches a discrete constrained Lagrangian system. A step that does not converge leaves everything as it was.
template <DiscreteSystem Sys> class Integrator {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  Integrator(Sys system, const State<G>& initial, const ArrowOf<G>& configuration,
             std::unique_ptr<StepSolver<Sys>> solver)
      : stepper_(std::move(system), std::move(solver)),
        start_(start_time(stepper_.system())),
        walk_(stepper_.system().groupoid, initial, configuration, start_) {}

  const TrajectoryPoint<Sys>& point() const { return walk_.point(); }
  const Sys& system() const { return stepper_.system(); }
  /// The system's own, else those of a self-adjoint discretisation.
  MethodTraits traits() const {
    if constexpr (HasTraits<Sys>) {
      return system().traits();
    } else {
      return {"equal steps", 2, true, Variational<Sys>, false};
    }
  }

  StepReport advance();
  /// Visits all that the next step goes on from.
  void persist(Tape& tape) {
    stepper_.persist(tape);
    walk_.persist(system().groupoid, tape);
  }

 private:
  Stepper<Sys> stepper_;
  double start_;
  Walk<Sys> walk_;
};

template <DiscreteSystem Sys> LAGROID_FLATTEN StepReport Integrator<Sys>::advance() {
  StepSolution<Sys> solution;
  const StepReport report = stepper_.solve(point().state, solution);
  if (report.converged()) {
    walk_.join(system().groupoid, solution);
    if constexpr (HasTimeStep<Sys>) {
      walk_.arrive_at(start_ + double(point().index + 1) * system().h, system().h);
      set_time(stepper_.system(), point().time);
    } else {
      walk_.arrive(0);
    }
  }
  return report;
}

}  // namespace lagroid
