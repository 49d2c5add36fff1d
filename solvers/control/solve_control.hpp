#pragma once
/// Solves an optimal control problem on a groupoid, with bounds, inequalities and free duration.
///
///     ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, /*duration_is_free*/ true};
///     task.lower(0) = -1, task.upper(0) = 1;
///     const auto found = solve_control(task, 200);
///     if (!found.report.converged()) std::cerr << found.report.message;
///
/// Requires bounds with lower < upper, a positive duration and at least two stages (std::invalid_argument otherwise).
/// Returns the trajectory, its costates and multipliers, and a report with a typed status; where it is not `converged`
/// the trajectory is the last iterate. What converged is carried on to its active inequalities, where they can be told
/// (`crossover`); else it is the interior point's.

#include <lagroid/solvers/control/interior_point.hpp>
#include <lagroid/solvers/control/optimality/crossover.hpp>
#include <lagroid/solvers/control/transcription_of.hpp>

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

namespace lagroid {

template <class Sys> struct ControlSolution {
  ControlTrajectory<Sys> trajectory;
  /// lambda_k of phi at each stage, of which the last has those of the conditions on the end behind it.
  std::vector<std::vector<double>> costates;
  /// z_k >= 0 of gamma, then of the finite bounds: of each control the upper, then the lower.
  std::vector<std::vector<double>> inequality_multipliers;
  ControlReport report;
  CrossoverReport crossover;  ///< from the interior point's solution to what stands here
};

/// Throws std::invalid_argument for bounds, a duration or a trajectory that are none.
template <class Sys> void require_control_task(const ControlTask<Sys>& task, const ControlTrajectory<Sys>& start) {
  for (int i = 0; i < Sys::controls; ++i)
    if (!(task.lower(i) < task.upper(i)))
      throw std::invalid_argument(fmt::format("control {}: its lower bound {} is not below its upper bound {}", i + 1,
                                              task.lower(i), task.upper(i)));
  if (!(task.duration > 0)) throw std::invalid_argument(fmt::format("duration: {} is not positive", task.duration));
  if (start.arrows.size() < 2 || start.controls.size() != start.arrows.size())
    throw std::invalid_argument("a trajectory has at least two arrows, and as many controls");
}

/// From a trajectory of one's own.
template <class Sys>
ControlSolution<Sys> solve_control(const ControlTask<Sys>& task, ControlTrajectory<Sys> start,
                                   const ControlOptions& options = {}) {
  require_control_task(task, start);
  TranscriptionOf<Sys> transcription(task, std::move(start));
  InteriorPoint solver(transcription, options);
  ControlSolution<Sys> out;
  out.report = solver.solve();
  const auto keep = [&](const auto& solved) {
    const auto rows = [](const StageRows& of, long stages) {
      std::vector<std::vector<double>> all;
      for (long k = 0; k < stages; ++k) all.emplace_back(of[k], of[k] + of.length());
      return all;
    };
    out.trajectory = transcription.trajectory();
    out.costates = rows(solved.costates(), transcription.sizes().stages);
    out.inequality_multipliers = rows(solved.inequality_multipliers(), transcription.sizes().stages);
  };
  keep(solver);
  if (!options.crossover || !out.report.converged()) return out;
  Crossover crossover(transcription);
  out.crossover = crossover.cross(solver.costates(), solver.inequality_multipliers());
  if (!out.crossover.crossed()) return out;
  keep(crossover);
  out.report.cost = out.crossover.cost;
  out.report.stationarity = out.crossover.after.stationarity;
  out.report.violation = out.crossover.after.violation;
  out.report.complementarity = out.crossover.after.complementarity;
  return out;
}

/// From the straight trajectory of so many stages.
template <class Sys>
ControlSolution<Sys> solve_control(const ControlTask<Sys>& task, long stages, const ControlOptions& options = {}) {
  if (stages < 2) throw std::invalid_argument("a trajectory has at least two arrows");
  return solve_control(task, straight_trajectory(task, stages), options);
}

}  // namespace lagroid
