#pragma once
/// An optimal control problem solved by IPOPT: the same transcription, start and tolerance as the InteriorPoint's, and
/// a check of it by another's hand.
///
///     const auto found = solve_control_by_ipopt(task, straight_trajectory(task, 100));
///     if (!found.report.converged()) std::cerr << found.report.message;
///
/// IPOPT knows one vector space, the chart about the start (trajectory_chart.hpp), with the exact first and second
/// derivatives there; bounds of controls are bounds of its unknowns. Its options are its defaults but for the
/// tolerance, which is that of ControlOptions on constraints and complementarity too, for bounds that are not relaxed,
/// for MUMPS as linear solver, and for no end at a tolerance that is merely acceptable.
///
/// Requires and returns what solve_control does; the residuals of the report are taken of the transcription, by the
/// same function. Throws std::invalid_argument as that does, and MissingLibrary in a build without IPOPT.
///
/// Waechter and Biegler, Math. Program. 106 (2006).

#include <lagroid/solvers/control/ipopt/has_ipopt.hpp>
#include <lagroid/solvers/control/ipopt/trajectory_chart.hpp>
#include <lagroid/solvers/control/solve_control.hpp>

#include <utility>

namespace lagroid {

struct IpoptSolution {
  ControlReport report;
  StageRows costates;
  StageRows inequality_multipliers;
};

/// From the chart's origin; leaves the chart at the last iterate.
IpoptSolution solve_by_ipopt(TrajectoryChart& chart, const ControlOptions& options);

template <class Sys>
ControlSolution<Sys> solve_control_by_ipopt(const ControlTask<Sys>& task, ControlTrajectory<Sys> start,
                                            const ControlOptions& options = {}) {
  require_control_task(task, start);
  TrajectoryChartOf<Sys> chart(task, std::move(start));
  IpoptSolution found = solve_by_ipopt(chart, options);
  ControlSolution<Sys> out;
  out.report = std::move(found.report);
  out.trajectory = chart.trajectory();
  for (long k = 0; k < chart.transcription().sizes().stages; ++k) {
    const auto row = [k](const StageRows& of) { return std::vector<double>(of[k], of[k] + of.length()); };
    out.costates.push_back(row(found.costates));
    out.inequality_multipliers.push_back(row(found.inequality_multipliers));
  }
  return out;
}

}  // namespace lagroid
