#pragma once
/// The boundary-value problem of any system, from guesses to stationary paths.

#include <lagroid/solvers/multistart.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

namespace lagroid {

struct MultistartOptions {
  int starts = 40;                ///< the geodesic, then geodesics with random sine modes
  std::uint64_t seed = 1;         ///< of the random modes
  double amplitude = 0;           ///< their size, in coordinates of AG; 0: the length of the geodesic, or one
  std::size_t coarse_steps = 20;  ///< arrows of the first stage
  std::function<void(int)> report = [](int) {};  ///< called with the number of starts done
  int threads = 0;                               ///< solves at a time; 0: as many as there are processors
};

/// The path through tau_q(k v / N), tau_q(v) the boundary arrow: the straight line from one end to the other.
template <DiscreteSystem Sys> Path<Sys> geodesic_path(const BoundaryProblem<Sys>& problem, std::size_t count) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = problem.system.groupoid;
  const auto start = groupoid.source(problem.boundary);
  const AlgebroidVector<G> v = groupoid.tau_inverse(problem.boundary);
  std::vector<ArrowOf<G>> reach;
  for (std::size_t k = 0; k < count; ++k)
    reach.push_back(groupoid.tau(start, AlgebroidVector<G>(v * (double(k) / double(count)))));
  reach.push_back(problem.boundary);
  Path<Sys> rest(count);
  for (auto& step : rest) step.multipliers.setZero();
  return detail::path_through(problem.system, reach, rest);
}

/// Stationary paths between the ends of the problem's boundary arrow, `steps` arrows long: multistart with at most
/// `coarse_steps` arrows over the same time, then continuation in their number. A system without a time step is solved
/// as it is. Where the coarse problem led nowhere, the problem asked for gets starts of its own. Needs nothing of the
/// system but what every system has. Throws std::invalid_argument where `inadmissible_ends` has a reason or an option
/// is out of range.
template <DiscreteSystem Sys>
MultistartResult<Sys> solve_boundary(const BoundarySolver<Sys>& solver, const BoundaryProblem<Sys>& problem,
                                     std::size_t steps, const MultistartOptions& options = {}) {
  if (const auto why = inadmissible_ends(problem)) throw std::invalid_argument(*why);
  if (steps < 2) throw std::invalid_argument("a boundary-value problem needs at least 2 steps");
  if (options.coarse_steps < 2) throw std::invalid_argument("coarse_steps must be at least 2");
  if (options.starts < 1) throw std::invalid_argument("starts must be at least 1");
  if (!(options.amplitude >= 0 && std::isfinite(options.amplitude)))
    throw std::invalid_argument("amplitude must be zero or positive, and finite");
  std::vector<BoundaryStage<Sys>> stages{{problem, steps}};
  if constexpr (HasTimeStep<Sys>) {
    stages.clear();
    for (std::size_t n = std::min(steps, options.coarse_steps);; n = std::min(2 * n, steps)) {
      stages.push_back({problem, n});
      if (n == steps) break;
      stages.back().problem.system.h = problem.system.h * double(steps) / double(n);
    }
  }
  const auto guess = [&](const BoundaryStage<Sys>& stage) {
    return [&](int index) {
      const Path<Sys> straight = geodesic_path(stage.problem, stage.steps);
      if (index == 0) return straight;
      // Each start has its own generator, so that start i is the same whatever the number of starts.
      std::seed_seq sequence{std::uint32_t(options.seed), std::uint32_t(options.seed >> 32), std::uint32_t(index)};
      std::mt19937_64 generator(sequence);
      const double length = problem.system.groupoid.tau_inverse(problem.boundary).norm();
      const double amplitude = options.amplitude > 0 ? options.amplitude : length > 1e-3 ? length : 1;
      std::normal_distribution<double> normal(0, amplitude);
      return displaced(stage.problem, straight, sine_modes<Sys>(stage.steps, 3, [&] { return normal(generator); }),
                       1.0);
    };
  };
  auto result = multistart(solver, stages, options.starts, guess(stages.front()), options.report, options.threads);
  if (result.solutions.empty() && stages.size() > 1) {
    const int spent = result.iterations;
    result = multistart(solver, std::vector{stages.back()}, options.starts, guess(stages.back()), options.report,
                        options.threads);
    result.iterations += spent;
  }
  return result;
}

}  // namespace lagroid
