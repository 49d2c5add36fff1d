#pragma once
/// The times of boundary values: equal steps, or steps that vary.

#include "scene_keys.hpp"
#include "system_module.hpp"

#include <lagroid/run/run_result.hpp>
#include <lagroid/solvers/boundary/multistart.hpp>
#include <lagroid/solvers/boundary/times/varied_steps.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// The stationary paths of a search with their times.
template <DiscreteSystem Sys> struct FoundPaths : MultistartEffort {
  std::vector<TimedSolution<Sys>> solutions;  ///< cheapest first
  TimedSolution<Sys> best_failure;

  FoundPaths(const BoundaryStage<EqualSteps<Sys>>& stage, const MultistartResult<EqualSteps<Sys>>& found)
      : MultistartEffort(found), best_failure(with_times<Sys>(stage, found.best_failure)) {
    for (const auto& solution : found.solutions) solutions.push_back(with_times<Sys>(stage, solution));
  }
};

/// [time] mode of a boundary value: equal steps; adaptive ones, which are part of the path, where the system is known
/// for every step; prescribed ones, in proportion to a time scale of its arrows, where it has one.
template <DiscreteSystem Sys> TimeMode read_boundary_mode(const Section& scene) {
  static_assert(time_scale_of_arrows_fits<Sys>,
                "time_scale(g) is there but does not fit: a const template of an arrow's scalar, which returns it, of "
                "a system that takes the step as an argument (see HasTimeScaleOfArrows)");
  const auto word = [](TimeMode mode) { return std::string(integration_method({.mode = mode}).name); };
  const std::string chosen = read_key(scene.section_or_empty("time"), time_keys::boundary_mode(boundary_modes<Sys>()));
  for (const TimeMode mode : {TimeMode::adaptive, TimeMode::prescribed})
    if (chosen == word(mode)) return mode;
  if (chosen == word(TimeMode::controlled)) return TimeMode::prescribed;  // the word for it until 0.4
  return TimeMode::fixed;
}

/// Gives all paths the steps of that mode, or says why none of those sought has them.
template <Timed Sys>
void vary_steps(TimeMode mode, const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                StationaryKind kind, FoundPaths<Sys>& found, RunResult& result) {
  std::vector<TimedSolution<Sys>> varied;
  std::optional<TimedSolution<Sys>> failure;
  const auto is_sought = [&](const TimedSolution<Sys>& path) {
    return kind == StationaryKind::stationary || path.kind.is_minimum;
  };
  const std::size_t count = found.solutions.size();
  for (auto& equal : found.solutions) {
    TimedSolution<Sys> solution = solve_varied_steps(mode, system, boundary, equal);
    found.iterations += solution.iterations;
    if (solution.converged()) {
      varied.push_back(std::move(solution));
    } else if (!failure || (is_sought(equal) && !is_sought(*failure))) {
      solution.kind = equal.kind;
      static_cast<TimedPath<Sys>&>(solution) = std::move(equal);
      failure = std::move(solution);
    }
  }
  if (failure)
    result.notes.push_back(
        fmt::format("{} of {} path(s) of equal steps became one of steps that vary; the cheapest of the others did "
                    "not: {}",
                    varied.size(), count, to_string(failure->status)));
  if (failure && is_sought(*failure) && std::none_of(varied.begin(), varied.end(), is_sought)) varied.clear();
  if (failure && varied.empty()) {
    result.status = std::string(to_string(failure->status));
    result.message =
        fmt::format("boundary value: {}; time.mode = \"{}\" takes equal steps",
                    failure->message.empty() ? "the iteration for the steps did not converge" : failure->message,
                    mode_of_equal_steps);
    found.best_failure = std::move(*failure);
  }
  std::stable_sort(varied.begin(), varied.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  found.solutions = std::move(varied);
}

/// What there is to say of the steps of a path.
template <Timed Sys> std::string words_of_steps(const TimedSolution<Sys>& solution) {
  const auto& times = solution.times;
  double shortest = times[1] - times[0];
  double longest = shortest;
  for (std::size_t k = 1; k + 1 < times.size(); ++k) {
    shortest = std::min(shortest, times[k + 1] - times[k]);
    longest = std::max(longest, times[k + 1] - times[k]);
  }
  const std::string steps = fmt::format("steps from {:.6g} to {:.6g} s", shortest, longest);
  if (!solution.step_multipliers.empty()) {
    double largest = 0;
    for (const double nu : solution.step_multipliers) largest = std::max(largest, std::abs(nu));
    return fmt::format("{}, by h(g); their multipliers nu = E_d - E are at most {:.3g}, E = {:.12g}", steps, largest,
                       solution.energy);
  }
  return fmt::format(
      "{}; discrete energy E_d = {:.12g}{}: the costate of the end time, by which the cost changes, is -E_d", steps,
      solution.energy, TimeDependent<Sys> ? " on the first arrow" : "");
}

}  // namespace lagroid::app
