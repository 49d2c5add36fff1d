#pragma once
/// Solves an optimal control problem on a groupoid, with bounds, inequalities and free duration.
///
///     ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, /*duration_is_free*/ true};
///     task.lower(0) = -1, task.upper(0) = 1;
///     const auto found = solve_control(task, 200);
///     if (!found.report.converged()) std::cerr << found.report.message;
///
/// Requires bounds with lower < upper (where they are equal the control is fixed), positive durations, at least two
/// stages, and conditions on nodes that are free (std::invalid_argument otherwise). Returns the trajectory, its
/// costates and multipliers, and a report with a typed status; where it is not `converged` the trajectory is the last
/// iterate. What converged is carried on to its active inequalities, where they can be told (`crossover`); else it is
/// the interior point's.

#include <lagroid/solvers/control/optimality/crossed_solution.hpp>
#include <lagroid/solvers/control/transcription_of.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

template <class Sys> struct ControlSolution {
  ControlTrajectory<Sys> trajectory;
  /// lambda_k of phi at each stage, behind it those of conditions on the node where it ends (on the first, of stage 0).
  std::vector<std::vector<double>> costates;
  /// z_k >= 0 of gamma, then of the durations' bounds, longest and shortest, where a phase has such, at its first
  /// stage, then of the finite bounds: of each control the upper, then the lower.
  std::vector<std::vector<double>> inequality_multipliers;
  ControlReport report;
  CrossoverReport crossover;  ///< from the interior point's solution to what stands here
};

/// Throws std::invalid_argument for bounds, a duration or a trajectory that are none.
template <class Sys> void require_control_task(const ControlTask<Sys>& task, const ControlTrajectory<Sys>& start) {
  const std::vector<ControlPhase<Sys>> phases = phases_of(task, long(start.arrows.size()));
  for (std::size_t p = 0; p < phases.size(); ++p) {
    const ControlPhase<Sys>& phase = phases[p];
    const std::string where = task.phases.empty() ? "" : fmt::format("phase {}: ", p + 1);
    for (int i = 0; i < Sys::controls; ++i)
      if (!(phase.lower(i) < phase.upper(i)) && !(phase.lower(i) == phase.upper(i) && std::isfinite(phase.lower(i))))
        throw std::invalid_argument(fmt::format("{}control {}: its lower bound {} is not below its upper bound {}",
                                                where, i + 1, phase.lower(i), phase.upper(i)));
    if (!(phase.duration > 0))
      throw std::invalid_argument(fmt::format("{}duration: {} is not positive", where, phase.duration));
    if (phase.duration_is_free && !(phase.shortest < phase.longest))
      throw std::invalid_argument(
          fmt::format("{}its shortest duration {} is not below its longest {}", where, phase.shortest, phase.longest));
    if (phase.stages < 1) throw std::invalid_argument(fmt::format("{}it has no stages", where));
  }
  if (start.arrows.size() < 2 || start.controls.size() != start.arrows.size())
    throw std::invalid_argument("a trajectory has at least two arrows, and as many controls");
  long stages = 0;
  for (const PhaseSteps& each : start.phases) stages += each.stages;
  if (start.phases.size() != phases.size() || stages != long(start.arrows.size()))
    throw std::invalid_argument("a trajectory has the phases of its task, whose stages are its arrows");
  const auto is_free = [](const auto& of) { return std::any_of(of.begin(), of.end(), [](bool free) { return free; }); };
  if ((task.start_condition && !is_free(task.free_start)) || (task.end_condition && !is_free(task.free_end)) ||
      phases.back().end_condition)
    throw std::invalid_argument("a condition on an end of the motion is the task's, and that end is free in part");
  if (task.end_cost && (!is_free(task.free_end) || task.end_cost->size() != 1))
    throw std::invalid_argument("a cost of the end is one number, of an end that is free in part");
}

/// From a trajectory of one's own.
template <class Sys>
ControlSolution<Sys> solve_control(const ControlTask<Sys>& task, ControlTrajectory<Sys> start,
                                   const ControlOptions& options = {}) {
  require_control_task(task, start);
  TranscriptionOf<Sys> transcription(task, std::move(start));
  ControlSolution<Sys> out;
  const CrossedSolution solved = solve_and_cross(transcription, options, [&](const auto& by) {
    const auto rows = [](const StageRows& of, long stages) {
      std::vector<std::vector<double>> all;
      for (long k = 0; k < stages; ++k) all.emplace_back(of[k], of[k] + of.length());
      return all;
    };
    out.trajectory = transcription.trajectory();
    out.costates = rows(by.costates(), transcription.sizes().stages);
    out.inequality_multipliers = rows(by.inequality_multipliers(), transcription.sizes().stages);
  });
  out.report = solved.report;
  out.crossover = solved.crossover;
  return out;
}

/// From the straight trajectory of so many stages, or of those of the task's phases.
template <class Sys>
ControlSolution<Sys> solve_control(const ControlTask<Sys>& task, long stages, const ControlOptions& options = {}) {
  if (stages < 2 && task.phases.empty()) throw std::invalid_argument("a trajectory has at least two arrows");
  return solve_control(task, straight_trajectory(task, stages), options);
}

}  // namespace lagroid
