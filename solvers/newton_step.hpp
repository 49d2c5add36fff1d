#pragma once
/// Newton's iteration on the alpha-fibre of a groupoid.

#include <lagroid/solvers/step_solver.hpp>

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace lagroid {

struct NewtonOptions {
  int max_iterations = 60;
  int max_halvings = 12;       ///< of a Newton step that would increase the residual
  double accept_excess = 100;  ///< a residual that stagnates is accepted up to this many times its round-off level
  double tolerance = 0;        ///< a scaled residual this small is accepted too; 0: iterate to round-off
};

/// Version 1 of the Newton iteration ([N] (3.5)), carried from Lie groups to alpha-fibres: g <- g tau(w), lambda <-
/// lambda + dlambda, with (w, dlambda) from the matrix of `StepEquations` at the current arrow. Unknowns and equations
/// are scaled to a matrix with entries near one. Iterates to the round-off level of every equation, then once more with
/// the same factors: what Newton leaves below that level is not random, and would add up over a long run. No
/// allocation.
template <DiscreteSystem Sys> class NewtonStep final : public StepSolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;

  explicit NewtonStep(NewtonOptions options = {}) : options_(options) {}

  StepReport solve(const Sys& system, const State<G>& state, StepSolution<Sys>& solution) override {
    constexpr int n = Sys::dimension;
    StepReport report;
    Step<Sys>& step = solution.step;
    solution.derivative = two_sided(system, step.arrow, step.multipliers);
    ScaledResidual<Sys> current(system, state, step, solution.derivative, scaling_, /*rescale=*/true);
    for (;; ++report.iterations) {
      report.residual = current.norm;
      report.excess = current.excess;
      if (!std::isfinite(current.norm)) return end(report, SolveStatus::not_finite);
      lu_.compute(scaling_.apply(current.jacobian));
      if (!(lu_.rcond() > 1e-15)) return end(report, SolveStatus::singular);
      typename E::Residual correction = corrected(current);
      if (current.excess <= 1 || current.norm <= options_.tolerance) {
        const Step<Sys> once_more = moved(system, step, correction, 1);
        const auto derivative = two_sided(system, once_more.arrow, once_more.multipliers);
        const ScaledResidual<Sys> next(system, state, once_more, derivative, scaling_, /*rescale=*/false);
        if (next.excess < current.excess) {
          step = once_more;
          solution.derivative = derivative;
          report.residual = next.norm;
          report.excess = next.excess;
          correction = corrected(next);
        }
        solution.remainder = correction.template head<n>();
        return converged(report, system, step);
      }
      if (report.iterations == options_.max_iterations) return end(report, SolveStatus::not_converged);

      bool advanced = false;
      double fraction = 1;
      for (int halving = 0; halving <= options_.max_halvings && !advanced; ++halving, fraction /= 2) {
        const Step<Sys> trial = moved(system, step, correction, fraction);
        const auto derivative = two_sided(system, trial.arrow, trial.multipliers);
        const ScaledResidual<Sys> next(system, state, trial, derivative, scaling_, /*rescale=*/false);
        if (next.norm < current.norm || next.excess < current.excess) {
          advanced = true;
          step = trial;
          solution.derivative = derivative;
          current = next;
        } else if (current.excess <= options_.accept_excess) {
          solution.remainder = correction.template head<n>();
          return converged(report, system, step);
        }
      }
      if (!advanced) return end(report, SolveStatus::stagnated);
    }
  }

 private:
  using E = StepEquations<Sys>;

  /// The Newton correction for a residual, with the factors at hand.
  typename E::Residual corrected(const ScaledResidual<Sys>& at) const {
    const typename E::Residual right = at.residual.cwiseProduct(scaling_.row);
    return -lu_.solve(right).cwiseProduct(scaling_.column);
  }
  static Step<Sys> moved(const Sys& system, const Step<Sys>& step, const typename E::Residual& correction,
                         double fraction) {
    const AlgebroidVector<G> w = fraction * correction.template head<Sys::dimension>();
    const auto& groupoid = system.groupoid;
    return {groupoid.project(groupoid.compose(step.arrow, groupoid.tau(groupoid.target(step.arrow), w))),
            step.multipliers + fraction * correction.template tail<Sys::constraints>()};
  }

  static StepReport end(StepReport report, SolveStatus status) {
    report.status = status;
    return report;
  }
  static StepReport converged(StepReport report, const Sys& system, const Step<Sys>& step) {
    if constexpr (HasBranch<Sys>) {
      if (!system.admissible(step.arrow)) return end(report, SolveStatus::left_domain);
    }
    return end(report, SolveStatus::converged);
  }

  NewtonOptions options_;
  Scaling<E::size> scaling_;
  Eigen::PartialPivLU<typename E::Jacobian> lu_;
};

}  // namespace lagroid
