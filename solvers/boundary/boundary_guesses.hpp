#pragma once
/// Starting paths of a boundary-value problem: straight, wound and bent.
///
///     straight:  q -> tau_q(t v), tau_q(v) = g;    wound:  X_k loop(axis, turns k / N);    bent:  X_k tau(v_k)
///
/// A descent stays in the homotopy class of its start, so that starts must lie in several of them.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const Path<Kepler> straight = geodesic_path(problem, 100);
///     const Path<Kepler> seventh = BoundaryGuesses{.seed = 1}(problem, 100, 6);
///
/// Requires a boundary arrow in the domain of tau^{-1}. The same seed and index give the same path.

#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/solvers/boundary/continuation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace lagroid {

/// The path through tau_q(t v), t = k / count, tau_q(v) the boundary arrow: the straight line from one end to the
/// other.
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

/// The path with so many turns of each loop on the way (loops.hpp): through X_k loop(axis, turns k / N), X_k what it
/// reaches after k of N arrows.
template <DiscreteSystem Sys>
Path<Sys> wound(const Sys& system, const Path<Sys>& path, const AlgebroidVector<typename Sys::GroupoidType>& axis,
                const Eigen::VectorXd& turns) {
  const auto& groupoid = system.groupoid;
  auto reach = detail::reaches(system, path);
  for (std::size_t k = 1; k + 1 < reach.size(); ++k) {
    const double t = double(k) / double(path.size());
    const auto turned = loop_of(system, groupoid.target(reach[k]), axis, t * turns);
    reach[k] = groupoid.project(groupoid.compose(reach[k], turned));
  }
  return detail::path_through(system, reach, path);
}

/// Starting paths: the first is the straight line, or the system's own, the others are drawn from it. Of three in
/// succession one winds forward about each loop, one backward and one not at all; a winding has one turn, seldom more.
/// All are bent by random multiples of the first sine modes, of every size about `amplitude`.
struct BoundaryGuesses {
  std::uint64_t seed = 1;
  double amplitude = 0;  ///< in coordinates of AG; 0: the length of the straight line, or one

  /// Start `index` is the same whatever the number of starts.
  template <DiscreteSystem Sys>
  Path<Sys> operator()(const BoundaryProblem<Sys>& problem, std::size_t count, int index) const {
    Path<Sys> path = straight(problem, count);
    if (index == 0) return path;
    auto generator = generator_of(0, index);
    const double length = problem.system.groupoid.tau_inverse(problem.boundary).norm();
    const double size = amplitude > 0 ? amplitude : length > 1e-3 ? length : 1;
    std::uniform_real_distribution<double> octave(-3, 1);
    std::normal_distribution<double> normal(0, size * std::exp2(octave(generator)));
    if (loop_count(problem.system) > 0) path = wound_by_chance(problem, path, index, generator);
    return displaced(problem, path, sine_modes<Sys>(count, 3, [&] { return normal(generator); }), 1.0);
  }

 private:
  std::mt19937_64 generator_of(int stream, int index) const {
    std::seed_seq sequence{std::uint32_t(seed), std::uint32_t(seed >> 32), std::uint32_t(stream), std::uint32_t(index)};
    return std::mt19937_64(sequence);
  }

  template <DiscreteSystem Sys> static Path<Sys> straight(const BoundaryProblem<Sys>& problem, std::size_t count) {
    if constexpr (HasPath<Sys>) {
      Path<Sys> path;
      for (const auto& arrow : problem.system.path(problem.boundary, long(count)))
        path.push_back({arrow, Sys::Multipliers::Zero()});
      if (!path.empty()) return path;
    }
    return geodesic_path(problem, count);
  }

  template <DiscreteSystem Sys>
  Path<Sys> wound_by_chance(const BoundaryProblem<Sys>& problem, const Path<Sys>& path, int index,
                            std::mt19937_64& generator) const {
    constexpr std::array<int, 3> ways{0, 1, -1};
    Eigen::VectorXd turns(loop_count(problem.system));
    const int block = (index - 1) / 3;
    auto shuffler = generator_of(1, block);
    std::array<int, 3> order{0, 1, 2};
    std::shuffle(order.begin(), order.end(), shuffler);
    std::uniform_int_distribution<int> any(0, 2);
    std::geometric_distribution<int> more(0.85);
    for (int i = 0; i < turns.size(); ++i) {
      // Of three loops any two go through all ways to combine theirs in nine starts.
      const int shift = i < 3 ? i * block : any(shuffler);
      turns(i) = ways[std::size_t((order[std::size_t((index - 1) % 3)] + shift) % 3)] * (1 + more(generator));
    }
    // About the straight line's own direction, and about any other.
    AlgebroidVector<typename Sys::GroupoidType> axis = problem.system.groupoid.tau_inverse(problem.boundary);
    std::normal_distribution<double> normal;
    if (std::bernoulli_distribution()(generator))
      for (double& x : axis) x = normal(generator);
    return wound(problem.system, path, axis, turns);
  }
};

}  // namespace lagroid
