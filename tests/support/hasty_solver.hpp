#pragma once
/// A solver of steps that is wrong.

#include <lagroid/solvers/step/newton_step.hpp>

namespace lagroid {

/// Calls a step solved after one iteration.
template <class Sys> class Hasty final : public StepSolver<Sys> {
 public:
  StepReport solve(const Sys& system, const State<typename Sys::GroupoidType>& state,
                   StepSolution<Sys>& solution) override {
    StepReport report = newton_.solve(system, state, solution);
    report.status = SolveStatus::converged;
    return report;
  }

 private:
  NewtonStep<Sys> newton_{NewtonOptions{.max_iterations = 1}};
};

}  // namespace lagroid
