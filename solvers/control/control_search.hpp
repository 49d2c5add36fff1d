#pragma once
/// Optimal control from many starts: one start finds one local minimum, and which one is chance. The first start is the
/// straight trajectory, the second what the motion does by itself, bent toward the end. Of the others, from the sixth
/// on, every second one is a motion whose controls jump between their bounds, bent likewise; the rest are bent by sine
/// modes, with the momenta of such a motion (`settle`) where there are any, and two of three wind about the loops of
/// the groupoid. From rest a car moves aside by none of the first two: there its constraints are dependent, and what
/// would lower their violation is of second order.
///
///     const ControlSearch<DubinsCar> found = search_control(task, 100, {.starts = 12});
///     for (const auto& each : found.minima) std::cout << each.report.cost << '\n';  // cheapest first
///
/// Requires what `solve_control` requires. Returns the distinct solutions, cheapest first, and how every start ended;
/// where none converged, the failure with the least violation. The same seed finds the same.

#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/solvers/control/search_starts.hpp>
#include <lagroid/solvers/control/solve_control.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <type_traits>
#include <vector>

namespace lagroid {

struct ControlSearchOptions {
  int starts = 10;
  std::uint64_t seed = 1;
  double amplitude = 0;  ///< of bends, in coordinates of AG; 0: the length of the straight trajectory, or one
  /// A start is given up after so many times the iterations of the slowest that has converged, at least 100: those that
  /// fail would take most of the time. 0: none is.
  double patience = 4;
  ControlOptions solver = {};
};

template <class Sys> struct ControlSearch {
  std::vector<ControlSolution<Sys>> minima;  ///< distinct solutions, cheapest first
  ControlSolution<Sys> best_failure;         ///< where there are none
  std::map<ControlStatus, int> outcomes;
  int iterations = 0;
};

/// Where a motion comes to with the controls of a trajectory and in its time, and by how much it misses the end.
template <class Sys> struct DrivenTrajectory {
  ControlTrajectory<Sys> trajectory;  ///< bent toward the end: node k by (k/N)^2 of what the last one is off
  double missed = 0;
};

/// What the motion does with the controls of `path`, bent toward the end. None where the equations do not determine
/// arrows, or have no solution on the way.
template <class Sys>
std::optional<DrivenTrajectory<Sys>> driven_trajectory(const ControlTask<Sys>& task, ControlTrajectory<Sys> path) {
  using G = typename Sys::GroupoidType;
  if constexpr (Sys::equalities != G::dimension) {
    return std::nullopt;
  } else {
    constexpr int n = G::dimension;
    using J = Jet<double, n>;
    const G& groupoid = task.system.groupoid;
    const long stages = long(path.arrows.size());
    const std::vector<ControlPhase<Sys>> phases = phases_of(task, stages);
    std::size_t phase = 0;
    long of_phase = 0;  // how many of its stages are done
    ArrowOf<G> reached = groupoid.unit(groupoid.source(task.boundary));
    std::vector<ArrowOf<G>> nodes;
    AlgebroidVector<G> v = AlgebroidVector<G>::Zero();
    for (long k = 0; k < stages; ++k, ++of_phase) {
      if (of_phase == path.phases[phase].stages) ++phase, of_phase = 0;
      ArrowOf<G> g = groupoid.tau(groupoid.target(reached), v);
      const auto& u = path.controls[std::size_t(k)];
      const Vector<J, Sys::controls> control = u.template cast<J>();
      bool is_solved = false;
      for (int i = 0; i < 20 && !is_solved; ++i) {
        Vector<J, n> b;
        for (int j = 0; j < n; ++j) b(j) = J::variable(0, j);
        const Vector<J, n> zero = Vector<J, n>::Constant(J(0.0));
        const Vector<J, n> phi = phases[phase].system.constraint(
            groupoid.translate(zero, groupoid.template cast<J>(g), b), control, J(path.phases[phase].step));
        Matrix<double, n, n> slope;
        Vector<double, n> value;
        for (int j = 0; j < n; ++j) {
          value(j) = phi(j).value;
          for (int l = 0; l < n; ++l) slope(j, l) = phi(j).gradient(l);
        }
        const Vector<double, n> by = -solve_equilibrated(slope, value);
        if (!by.allFinite()) return std::nullopt;
        g = groupoid.project(groupoid.extend(g, by));
        is_solved = by.norm() <= 1e-9 * (1 + v.norm());
      }
      if (!is_solved) return std::nullopt;
      v = groupoid.tau_inverse(g);
      reached = groupoid.compose(reached, g);
      nodes.push_back(reached);
    }
    const AlgebroidVector<G> off = groupoid.tau_inverse(groupoid.compose(groupoid.inverse(reached), task.boundary));
    if (!off.allFinite()) return std::nullopt;
    ArrowOf<G> before = groupoid.unit(groupoid.source(task.boundary));
    for (long k = 0; k < stages; ++k) {
      const auto at = std::size_t(k);
      const double share = double(k + 1) / double(stages);
      const ArrowOf<G> here =
          k + 1 == stages ? task.boundary
                          : groupoid.project(groupoid.extend(nodes[at], AlgebroidVector<G>(share * share * off)));
      path.arrows[at] = groupoid.project(groupoid.compose(groupoid.inverse(before), here));
      before = here;
    }
    return DrivenTrajectory<Sys>{std::move(path), off.norm()};
  }
}

/// What the motion does with controls at rest, or in the middle of their bounds, bent toward the end: a trajectory to
/// start from, where the straight one is far from any motion.
template <class Sys>
std::optional<ControlTrajectory<Sys>> drifting_trajectory(const ControlTask<Sys>& task, long stages) {
  auto driven = driven_trajectory(task, straight_trajectory(task, stages));
  if (!driven) return std::nullopt;
  return std::move(driven->trajectory);
}

/// Of motions whose controls jump at random between their bounds, twice on the way and all at once, the one that comes
/// nearest to the end, bent toward it. None where no control is bounded on both sides.
template <class Sys, class Random>
std::optional<ControlTrajectory<Sys>> jumping_trajectory(const ControlTask<Sys>& task, long stages, Random& random) {
  constexpr int motions = 30;
  constexpr int pieces = 3;
  const ControlTrajectory<Sys> straight = straight_trajectory(task, stages);
  const std::vector<ControlPhase<Sys>> phases = phases_of(task, long(straight.arrows.size()));
  bool any = false;
  for (const ControlPhase<Sys>& phase : phases)
    for (int i = 0; i < Sys::controls; ++i)
      any = any || (std::isfinite(phase.lower(i)) && std::isfinite(phase.upper(i)) && phase.lower(i) < phase.upper(i));
  if (!any) return std::nullopt;
  std::uniform_real_distribution<double> share(0, 1), octave(-1, 1);
  std::uniform_int_distribution<int> level(0, 2);
  std::optional<DrivenTrajectory<Sys>> nearest;
  for (int k = 0; k < motions; ++k) {
    ControlTrajectory<Sys> path = straight;
    const bool alternate = share(random) < 0.5;
    std::array<double, pieces> ends{share(random), share(random), 1};
    std::sort(ends.begin(), ends.end());
    for (std::size_t p = 0; p < phases.size(); ++p)
      if (phases[p].duration_is_free) path.phases[p].step *= std::exp2(octave(random));
    for (int i = 0; i < Sys::controls; ++i) {
      std::array<double, pieces> levels;
      for (double& x : levels) x = 0.5 * level(random);
      if (alternate) levels[1] = 1 - (levels[2] = levels[0] = level(random) == 0 ? 0 : 1);
      std::size_t phase = 0;
      long before = 0;
      for (std::size_t j = 0; j < path.controls.size(); ++j) {
        while (long(j) >= before + path.phases[phase].stages) before += path.phases[phase++].stages;
        const double low = phases[phase].lower(i), high = phases[phase].upper(i);
        if (!std::isfinite(low) || !std::isfinite(high)) continue;
        const double t = double(j) / double(path.controls.size());
        const auto piece = std::size_t(std::upper_bound(ends.begin(), ends.end() - 1, t) - ends.begin());
        path.controls[j](i) = low + levels[piece] * (high - low);
      }
    }
    auto driven = driven_trajectory(task, std::move(path));
    if (driven && (!nearest || driven->missed < nearest->missed)) nearest = std::move(driven);
  }
  if (!nearest) return std::nullopt;
  return std::move(nearest->trajectory);
}

/// Start `index`, the same whatever the number of starts.
template <class Sys>
ControlTrajectory<Sys> control_guess(const ControlTask<Sys>& task, long stages, int index,
                                     const ControlSearchOptions& options = {}) {
  using G = typename Sys::GroupoidType;
  if (index == 1)
    if (const auto drifting = drifting_trajectory(task, stages)) return *drifting;
  ControlTrajectory<Sys> path = straight_trajectory(task, stages);
  stages = long(path.arrows.size());
  if (index == 0) return path;
  const G& groupoid = task.system.groupoid;
  std::seed_seq sequence{std::uint32_t(options.seed), std::uint32_t(options.seed >> 32), std::uint32_t(index)};
  std::mt19937_64 generator(sequence);
  constexpr int bends_first = 4;  // up to there, one for each way to wind
  if (index > bends_first && index % 2 == 1)
    if (auto jumping = jumping_trajectory(task, stages, generator)) {
      if constexpr (requires { task.system.settle(*jumping); }) task.system.settle(*jumping);
      return *std::move(jumping);
    }
  const AlgebroidVector<G> whole = groupoid.tau_inverse(task.boundary);
  const double length = whole.norm();
  const double amplitude = options.amplitude > 0 ? options.amplitude : length > 1e-3 ? length : 1;
  std::uniform_real_distribution<double> octave(-3, 1);
  std::normal_distribution<double> normal(0, amplitude * std::exp2(octave(generator)));
  constexpr int modes = 3;
  Eigen::Matrix<double, Sys::dimension, modes> bends;
  for (double& x : bends.reshaped()) x = normal(generator);

  const int bent = index <= bends_first ? index - 2 : index / 2;
  // Of three bends in succession one winds forward about each loop, one backward and one not at all.
  Eigen::VectorXd turns = Eigen::VectorXd::Zero(loop_count(task.system));
  for (int i = 0; i < turns.size(); ++i) turns(i) = std::array<int, 3>{1, -1, 0}[std::size_t((bent + 3 + i) % 3)];

  ArrowOf<G> reached = groupoid.unit(groupoid.source(task.boundary));
  ArrowOf<G> before = reached;
  for (long k = 0; k < stages; ++k) {
    reached = groupoid.compose(reached, path.arrows[std::size_t(k)]);
    ArrowOf<G> here = reached;
    if (k + 1 < stages) {
      const double t = double(k + 1) / double(stages);
      if (turns.size() > 0)
        here = groupoid.compose(here, loop_of(task.system, groupoid.target(here), whole, t * turns));
      AlgebroidVector<G> bend = AlgebroidVector<G>::Zero();
      for (int j = 0; j < modes; ++j) bend += std::sin((j + 1) * std::numbers::pi * t) / (j + 1) * bends.col(j);
      here = groupoid.project(groupoid.extend(here, bend));
    } else {
      here = task.boundary;
    }
    path.arrows[std::size_t(k)] = groupoid.project(groupoid.compose(groupoid.inverse(before), here));
    before = here;
  }
  const std::vector<ControlPhase<Sys>> phases = phases_of(task, stages);
  for (std::size_t p = 0; p < phases.size(); ++p)
    if (phases[p].duration_is_free)
      path.phases[p].step *= std::exp2(std::uniform_real_distribution<double>(-1, 1)(generator));
  if constexpr (requires { task.system.settle(path); }) task.system.settle(path);
  return path;
}

/// What solves from one start.
template <class Sys>
using ControlSolver =
    std::function<ControlSolution<Sys>(const ControlTask<Sys>&, ControlTrajectory<Sys>, const ControlOptions&)>;

/// Of a task in phases, their stages count and not `stages`. Before each start and in its every iteration
/// `keep_going(start)` decides whether it goes on.
template <class Sys>
ControlSearch<Sys> search_control(
    const ControlTask<Sys>& task, long stages, const ControlSearchOptions& options = {},
    const std::function<bool(int start)>& keep_going = [](int) { return true; },
    const ControlSolver<std::type_identity_t<Sys>>& solve =
        [](const auto&... with) { return solve_control(with...); }) {
  ControlSearch<Sys> found;
  const std::vector<ControlPhase<Sys>> phases = phases_of(task, stages);
  const bool any_is_free =
      std::any_of(phases.begin(), phases.end(), [](const auto& phase) { return phase.duration_is_free; });
  search_starts(found, options, any_is_free, keep_going, [&](int start, double longer, const ControlOptions& solver) {
    ControlTrajectory<Sys> path = control_guess(task, stages, start, options);
    for (std::size_t p = 0; p < phases.size(); ++p)
      if (phases[p].duration_is_free) path.phases[p].step *= longer;
    return solve(task, std::move(path), solver);
  });
  return found;
}

}  // namespace lagroid
