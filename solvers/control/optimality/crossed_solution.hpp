#pragma once
/// A transcription solved by the interior point method, led away from saddles, and carried on to its active
/// inequalities, where they can be told.
///
///     const CrossedSolution solved = solve_and_cross(transcription, options, [&](const auto& by) {
///       costates = by.costates();  // of the interior point method, then perhaps of the crossover
///     });
///
/// Requires a transcription that stands at a start. `keep(by)` is called at each solution that stands, where the
/// transcription is; the reports are those of the last one. From a saddle that leads to no solution of less cost the
/// transcription has moved on: the saddle, which was kept, is the solution, and nothing is crossed. Returns typed
/// statuses; nothing throws.

#include <lagroid/solvers/control/interior_point.hpp>
#include <lagroid/solvers/control/optimality/crossover.hpp>

namespace lagroid {

struct CrossedSolution {
  ControlReport report;
  CrossoverReport crossover;
};

template <class Keep>
CrossedSolution solve_and_cross(Transcription& transcription, const ControlOptions& options, const Keep& keep) {
  InteriorPoint solver(transcription, options);
  CrossedSolution out;
  out.report = solver.solve();
  keep(solver);
  constexpr int most_saddles = 5;
  for (int i = 0; i < most_saddles && out.report.is_saddle(); ++i) {
    const ControlReport beyond = solver.leave_saddle();
    if (!beyond.converged() || !(beyond.cost < out.report.cost)) {
      out.report.iterations = beyond.iterations;
      return out;
    }
    out.report = beyond;
    keep(solver);
  }
  if (!options.crossover || !out.report.converged()) return out;
  Crossover crossover(transcription, options.keep_going);
  out.crossover = crossover.cross(solver.costates(), solver.inequality_multipliers());
  if (!out.crossover.crossed()) return out;
  keep(crossover);
  out.report.cost = out.crossover.cost;
  out.report.stationarity = out.crossover.after.stationarity;
  out.report.violation = out.crossover.after.violation;
  out.report.complementarity = out.crossover.after.complementarity;
  return out;
}

}  // namespace lagroid
