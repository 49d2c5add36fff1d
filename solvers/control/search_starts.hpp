#pragma once
/// One start after another of an optimal control problem, until there are enough: what each found is sorted in.
///
///     search_starts(found, options, durations_are_free, [](int) { return true; },
///                   [&](int start, double longer, const ControlOptions& solver) {
///                     ControlTrajectory<DubinsCar> path = control_guess(task, stages, start, options);
///                     path.phases.front().step *= longer;
///                     return solve_control(task, path, solver);
///                   });
///
/// `found` has `minima`, `best_failure`, `outcomes` and `iterations` (ControlSearch), `options` has `starts`,
/// `patience` and the `solver`'s (ControlSearchOptions). A start is given up after `patience` times the iterations of
/// the slowest that has converged, at least a hundred; zero: none is. `keep_going(start)` is asked before each start
/// but the first and in every iteration; where it says no, the search ends with what it has. Solutions of the same cost
/// to 1e-7 are the same.
///
/// Where no start converges and durations are free, the same begin again with four times these (`longer`): of a motion
/// that must first go away from its end too short a guess shrinks to nothing.

#include <lagroid/solvers/control/interior_point.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace lagroid {

namespace detail {

template <class Found, class Options, class Solve>
void search_these_starts(Found& found, const Options& options, const std::function<bool(int start)>& keep_going,
                         const Solve& solve) {
  constexpr int least = 100;
  int slowest = 0;
  for (int i = 0; i < options.starts && (i == 0 || keep_going(i)); ++i) {
    ControlOptions solver = options.solver;
    solver.keep_going = [&, i] { return keep_going(i) && (!options.solver.keep_going || options.solver.keep_going()); };
    if (slowest > 0 && options.patience > 0)
      solver.max_iterations = std::min(solver.max_iterations, std::max(least, int(options.patience * slowest)));
    auto solution = solve(i, solver);
    const bool is_first = found.outcomes.empty();
    ++found.outcomes[solution.report.status];
    found.iterations += solution.report.iterations;
    const bool is_last = solution.report.status == ControlStatus::interrupted;
    if (!solution.report.converged()) {
      if (is_first || !(found.best_failure.report.violation <= solution.report.violation))
        found.best_failure = std::move(solution);
      if (is_last) break;
      continue;
    }
    slowest = std::max(slowest, solution.report.iterations);
    const auto same = [&](const auto& known) {
      return std::abs(known.report.cost - solution.report.cost) <= 1e-7 * (1e-6 + std::abs(solution.report.cost));
    };
    if (std::none_of(found.minima.begin(), found.minima.end(), same)) found.minima.push_back(std::move(solution));
  }
  std::sort(found.minima.begin(), found.minima.end(),
            [](const auto& a, const auto& b) { return a.report.cost < b.report.cost; });
}

}  // namespace detail

template <class Found, class Options, class Solve>
void search_starts(Found& found, const Options& options, bool durations_are_free,
                   const std::function<bool(int start)>& keep_going, const Solve& solve) {
  const auto search = [&](double longer, int before) {
    detail::search_these_starts(
        found, options, [&](int start) { return keep_going(before + start); },
        [&](int start, const ControlOptions& solver) { return solve(start, longer, solver); });
  };
  search(1, 0);
  if (found.minima.empty() && durations_are_free && !found.outcomes.contains(ControlStatus::interrupted))
    search(4, options.starts);
}

}  // namespace lagroid
