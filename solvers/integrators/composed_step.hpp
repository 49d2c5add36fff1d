#pragma once
/// A step of several stages, taken whole or not at all: the one loop of all composed steps, whatever their stages are.

#include <lagroid/solvers/step/step_solver.hpp>

namespace lagroid {

/// Takes one stage after another by `solve(stage)`, which reports on it and advances where it converged. Where one does
/// not, it is the last, and `restore()` puts back what was before the first. The report is that of the stage that
/// failed, or else of the worst; iterations are those of all.
template <class Stages, class Solve, class Restore>
StepReport step_by_stages(Stages& stages, const Solve& solve, const Restore& restore) {
  StepReport worst;
  int iterations = 0;
  for (auto& stage : stages) {
    const StepReport found = solve(stage);
    iterations += found.iterations;
    if (!found.converged() || !(found.roundoff_ratio < worst.roundoff_ratio)) worst = found;
    if (!found.converged()) {
      restore();
      break;
    }
  }
  worst.iterations = iterations;
  return worst;
}

}  // namespace lagroid
