#pragma once
/// The boundary-value problem of any system, from first guesses to all stationary paths that are found:
///
///     stationary paths of  sum_k L(g_k),    g_1 ... g_N = g,    from many starts, on few arrows first and then on N.
///
/// This is what a user calls; no guess is needed.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const auto found = solve_boundary(*make_boundary_solver<Kepler>(), problem, 100);  // on 100 arrows
///     const double least = found.solutions.empty() ? NAN : found.solutions.front().cost;
///
/// Requires two steps at least and a system as in boundary_problem.hpp. Returns distinct solutions, cheapest first,
/// each with its path, cost and kind; none found is no error: `best_failure` then has status and message. Throws
/// std::invalid_argument for ends that admit no path and options out of range.

#include <lagroid/solvers/boundary/boundary_guesses.hpp>
#include <lagroid/solvers/boundary/multistart.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

namespace lagroid {

struct MultistartOptions {
  int starts = 40;                ///< the straight line, then straight lines wound and bent (BoundaryGuesses)
  std::uint64_t seed = 1;         ///< of what is drawn
  double amplitude = 0;           ///< of the bends, in coordinates of AG; 0: the length of the straight line, or one
  std::size_t coarse_steps = 20;  ///< arrows of the first stage
  std::function<void(int)> report = [](int) {};  ///< called with the number of starts done
  int threads = 0;                               ///< solves at a time; 0: as many as there are processors
};

namespace detail {

/// What `solve_stages` below does, of any system.
template <DiscreteSystem Sys>
MultistartResult<Sys> solve_stages(const BoundarySolver<Sys>& solver, const std::vector<BoundaryStage<Sys>>& stages,
                                   const MultistartOptions& options) {
  if (const auto why = inadmissible_ends(stages.back().problem)) throw std::invalid_argument(*why);
  if (stages.back().steps < 2) throw std::invalid_argument("a boundary-value problem needs at least 2 steps");
  if (options.starts < 1) throw std::invalid_argument("starts must be at least 1");
  if (!(options.amplitude >= 0 && std::isfinite(options.amplitude)))
    throw std::invalid_argument("amplitude must be zero or positive, and finite");
  const auto solved = [&](const std::vector<BoundaryStage<Sys>>& along) {
    const auto guess = [&](int index) {
      return BoundaryGuesses{options.seed, options.amplitude}(along.front().problem, along.front().steps, index);
    };
    return detail::multistart<Sys>(solver, along, options.starts, guess, options.report, options.threads);
  };
  auto result = solved(stages);
  if (result.solutions.empty() && stages.size() > 1) {
    auto direct = solved({stages.back()});
    direct.add_effort(result);
    return direct;
  }
  return result;
}

/// What `solve_boundary` below does, of any system.
template <DiscreteSystem Sys>
MultistartResult<Sys> solve_boundary(const BoundarySolver<Sys>& solver, const BoundaryProblem<Sys>& problem,
                                     std::size_t steps, const MultistartOptions& options) {
  if (options.coarse_steps < 2) throw std::invalid_argument("coarse_steps must be at least 2");
  std::vector<BoundaryStage<Sys>> stages{{problem, steps}};
  if (has_time_step(problem.system)) {
    stages.clear();
    for (std::size_t n = std::min(steps, options.coarse_steps);; n = std::min(2 * n, steps)) {
      stages.push_back({problem, n});
      if (n == steps) break;
      set_time_step(stages.back().problem.system, time_step(problem.system) * double(steps) / double(n));
    }
  }
  return detail::solve_stages(solver, stages, options);
}

}  // namespace detail

/// Stationary paths of the last of `stages`, each an easier problem than the next: multistart with the first, then
/// continuation. Where that led nowhere, the problem asked for gets starts of its own. Throws std::invalid_argument
/// where `inadmissible_ends` has a reason or an option is out of range.
template <DiscreteSystem Sys>
MultistartResult<Sys> solve_stages(const BoundarySolver<Sys>& solver, const std::vector<BoundaryStage<Sys>>& stages,
                                   const MultistartOptions& options = {}) {
  const SizedBoundarySolver<Sys> sized(solver);
  return of_system(stages.back().problem.system, detail::solve_stages(*sized, by_sizes(stages), options));
}

/// Stationary paths between the ends of the problem's boundary arrow, `steps` arrows long: `solve_stages` with at most
/// `coarse_steps` arrows over the same time, then with more of them. A system without a time step is solved as it is.
/// Needs nothing of the system but what every system has; of what it or its groupoid say of windings (loops.hpp) the
/// starts make use.
template <DiscreteSystem Sys>
MultistartResult<Sys> solve_boundary(const BoundarySolver<Sys>& solver, const BoundaryProblem<Sys>& problem,
                                     std::size_t steps, const MultistartOptions& options = {}) {
  const SizedBoundarySolver<Sys> sized(solver);
  return of_system(problem.system, detail::solve_boundary(*sized, by_sizes(problem), steps, options));
}

}  // namespace lagroid

#include <lagroid/solvers/boundary/boundary_sizes.hpp>
