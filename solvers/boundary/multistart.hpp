#pragma once
/// Multistart: a boundary-value problem is solved from many guesses, and each distinct solution continued through
/// harder stages. One start finds one stationary path; which one is chance, and the cheapest is wanted.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const auto guess = [&](int i) { return BoundaryGuesses{}(problem, 20, i); };
///     const auto found = multistart<Kepler>(*make_boundary_solver<Kepler>(), {{problem, 20}}, 10, guess, [](int) {});
///
/// Requires guesses that the solver admits, and that `guess` may be called from several threads. Returns solutions,
/// cheapest first, the best failure and the effort; the result does not depend on the number of threads. Exceptions of
/// solver and guess are passed on.

#include <lagroid/solvers/boundary/continuation.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace lagroid {

/// What a multistart took.
struct MultistartEffort {
  int starts = 0;                       ///< all that were made
  std::map<SolveStatus, int> outcomes;  ///< of the starts, at the first stage
  int lost = 0;                         ///< solutions of the first stage that could not be continued
  int iterations = 0;
  int start_iterations = 0;  ///< of all starts at the first stage
  int most_iterations = 0;   ///< of one start

  /// Counts what another multistart of the same problem took as this one's own.
  void add_effort(const MultistartEffort& other) {
    starts += other.starts;
    for (const auto& [status, count] : other.outcomes) outcomes[status] += count;
    iterations += other.iterations;
    start_iterations += other.start_iterations;
    most_iterations = std::max(most_iterations, other.most_iterations);
  }
};

/// What a multistart found.
template <DiscreteSystem Sys> struct MultistartResult : MultistartEffort {
  std::vector<BoundarySolution<Sys>> solutions;  ///< distinct stationary points, cheapest of those found first
  BoundarySolution<Sys> best_failure;            ///< smallest residual among failures
};

template <DiscreteSystem Sys>
MultistartResult<Sys> of_system(const Sys& system, const MultistartResult<SizedSystemOf<Sys>>& found) {
  MultistartResult<Sys> out{found, {}, of_system(system, found.best_failure)};
  out.solutions.reserve(found.solutions.size());
  for (const auto& solution : found.solutions) out.solutions.push_back(of_system(system, solution));
  return out;
}

namespace detail {

/// Whether two converged solutions are the same; members of a continuous family are compared by cost alone.
template <DiscreteSystem Sys>
bool same_solution(const Sys& system, const BoundarySolution<Sys>& a, const BoundarySolution<Sys>& b) {
  if (std::abs(a.cost - b.cost) > 1e-7 * (1e-6 + std::abs(a.cost) + std::abs(b.cost))) return false;
  if (!a.kind.isolated || !b.kind.isolated || !a.kind.normal || !b.kind.normal) return true;
  const auto p = initial_momentum(system, a.path);
  const auto q = initial_momentum(system, b.path);
  return (p - q).norm() <= 1e-5 * (1 + p.norm());
}

template <DiscreteSystem Sys> void note_failure(MultistartResult<Sys>& result, BoundarySolution<Sys>&& failure) {
  const double best = result.best_failure.residual;
  if (result.best_failure.path.empty() || std::isnan(best) || failure.residual < best)
    result.best_failure = std::move(failure);
}

/// Where a solution is known already, its starts are counted as the known one's.
template <DiscreteSystem Sys>
void keep_if_new(std::vector<BoundarySolution<Sys>>& found, const Sys& system, BoundarySolution<Sys>&& solution) {
  const auto known =
      std::find_if(found.begin(), found.end(), [&](const auto& f) { return same_solution(system, f, solution); });
  if (known == found.end()) {
    found.push_back(std::move(solution));
  } else {
    known->starts += solution.starts;
  }
}

/// A saddle has a way down: solves again from paths bent a little away from each, and keeps what is new.
template <DiscreteSystem Sys>
void descend_from_saddles(const BoundarySolver<Sys>& solver, const BoundaryProblem<Sys>& problem, int threads,
                          std::vector<BoundarySolution<Sys>>& found, MultistartResult<Sys>& result) {
  constexpr long attempts = 4;
  std::vector<Path<Sys>> saddles;
  for (const auto& solution : found)
    if (!solution.kind.is_minimum) saddles.push_back(solution.path);
  const auto descend = [&](long i) {
    const auto& path = saddles[std::size_t(i / attempts)];
    return solver.solve(problem, bent(problem, path, int(1 + i % attempts)), /*keep_multipliers=*/false);
  };
  for (auto& next : results_of_tasks(attempts * long(saddles.size()), threads, descend, [](int) {})) {
    result.iterations += next.iterations;
    if (next.converged()) keep_if_new(found, problem.system, std::move(next));
  }
}

/// What `multistart` below does, of any system.
template <DiscreteSystem Sys>
MultistartResult<Sys> multistart(const BoundarySolver<Sys>& solver, const std::vector<BoundaryStage<Sys>>& stages,
                                 int starts, const std::function<Path<Sys>(int)>& guess,
                                 const std::function<void(int)>& report, int threads) {
  MultistartResult<Sys> result;
  result.starts = starts;
  std::vector<BoundarySolution<Sys>> found;
  const auto start = [&](long i) {
    return solver.solve(stages.front().problem, guess(int(i)), /*keep_multipliers=*/false);
  };
  for (auto& solution : results_of_tasks(starts, threads, start, report)) {
    result.start_iterations += solution.iterations;
    result.iterations += solution.iterations;
    result.most_iterations = std::max(result.most_iterations, solution.iterations);
    ++result.outcomes[solution.status];
    if (solution.converged()) {
      solution.starts = 1;
      keep_if_new(found, stages.front().problem.system, std::move(solution));
    } else {
      note_failure(result, std::move(solution));
    }
  }
  const bool minima = solver.stationary_kind() == StationaryKind::minima;
  if (minima) descend_from_saddles(solver, stages.front().problem, threads, found, result);
  for (std::size_t s = 1; s < stages.size(); ++s) {
    const BoundaryProblem<Sys>& problem = stages[s].problem;
    std::vector<BoundarySolution<Sys>> carried;
    const auto carried_on = [&](long i) {
      const auto& solution = found[std::size_t(i)];
      return detail::continue_to(solver, stages[s], solution, solution.path);
    };
    for (auto& next : results_of_tasks(long(found.size()), threads, carried_on, [](int) {})) {
      result.iterations += next.iterations;
      if (next.converged()) {
        keep_if_new(carried, problem.system, std::move(next));
      } else {
        ++result.lost;
        note_failure(result, std::move(next));
      }
    }
    found = std::move(carried);
  }
  if (minima && stages.size() > 1) descend_from_saddles(solver, stages.back().problem, threads, found, result);
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  result.solutions = std::move(found);
  return result;
}

}  // namespace detail

/// Solves stages[0] from `starts` guesses, then continues each distinct solution through the later stages, resampling
/// where the number of arrows changes. `solver.solve(problem, path, keep_multipliers)` does one solve, looking for
/// `solver.stationary_kind()`; `guess(i)` is the i-th starting path of the first stage; `report(i)` is called after
/// each start. Solves go on `threads` threads at once (0: all there are), and so do calls of `guess`; what is found
/// does not depend on their number.
template <DiscreteSystem Sys, class Guess, class Report>
MultistartResult<Sys> multistart(const BoundarySolver<Sys>& solver, const std::vector<BoundaryStage<Sys>>& stages,
                                 int starts, const Guess& guess, const Report& report, int threads = 0) {
  using Sized = SizedSystemOf<Sys>;
  const Sys& system = stages.front().problem.system;
  const SizedBoundarySolver<Sys> sized(solver);
  const auto sized_guess = [&](int index) { return by_sizes(system, Path<Sys>(guess(index))); };
  return of_system(system, detail::multistart<Sized>(*sized, by_sizes(stages), starts, sized_guess, report, threads));
}

}  // namespace lagroid
