#pragma once
/// Continuation: the solution of one boundary-value problem is the start for a neighbouring one, along stages (`carry`)
/// or along a homotopy s in [0, 1] (`follow`, with a secant predictor and adaptive steps in s).
///
/// Problems that no guess solves are reached from easy ones: other parameters, ends, or numbers of arrows.
///
///     const auto stage = [](double s) {
///       return BoundaryStage<Kepler>{{Kepler{}, {{1, 0}, {-0.3 - 0.2 * s, 0.8}}}, 100};
///     };
///     const auto solver = make_boundary_solver<Kepler>();
///     const auto first = solver->solve(stage(0).problem, geodesic_path(stage(0).problem, 100), false);
///     const auto last = follow(*solver, stage, first);
///
/// Requires a converged start and a family that is continuous in s. Returns the last solution with how far s came and a
/// status: `left_domain` where the solution is not near its prediction or no short arrow joins the old start to the new
/// one, else that of the last solve. `carry` throws what the solver throws.

#include <lagroid/solvers/boundary/boundary_by_sizes.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// A displacement a in A_qG with beta(tau_q(a)) = r, of least norm to first order; nothing if none is found. Objects
/// that no short arrow joins (points of different orbits) have none.
template <Groupoid G>
std::optional<AlgebroidVector<G>> displacement_between(const G& groupoid, const ObjectOf<G>& q, const ObjectOf<G>& r) {
  AlgebroidVector<G> a = AlgebroidVector<G>::Zero();
  if constexpr (G::object_coordinate_count() > 0) {
    const auto goal = groupoid.coordinates_of_object(r);
    const double size = 1 + goal.norm();
    for (int iteration = 0; iteration < 20; ++iteration) {
      const ArrowOf<G> arrow = groupoid.tau(q, a);
      const auto here = groupoid.target(arrow);
      const auto gap = (goal - groupoid.coordinates_of_object(here)).eval();
      if (!gap.allFinite()) return std::nullopt;
      if (gap.norm() <= 1e-14 * size) return a;
      Matrix<double, G::object_coordinate_count(), G::dimension> anchor;
      for (int i = 0; i < G::dimension; ++i)
        anchor.col(i) = groupoid.anchor(here, AlgebroidVector<G>(AlgebroidVector<G>::Unit(i)));
      // The anchor need not be one to one: a trace of the identity picks the least displacement.
      Matrix<double, G::dimension, G::dimension> normal = anchor.transpose() * anchor;
      normal.diagonal().array() += 1e-12 * normal.trace();
      a += normal.ldlt().solve(anchor.transpose() * gap);
    }
    const auto reached = groupoid.target(groupoid.tau(q, a));
    if (!((goal - groupoid.coordinates_of_object(reached)).norm() <= 1e-9 * size)) return std::nullopt;
  }
  return a;
}

/// The arrows from the first object of a path to its nodes, X_k = g_1 ... g_k, k = 0 ... N.
template <DiscreteSystem Sys>
std::vector<ArrowOf<typename Sys::GroupoidType>> reaches(const Sys& system, const Path<Sys>& path) {
  using G = typename Sys::GroupoidType;
  std::vector<ArrowOf<G>> out{system.groupoid.unit(system.groupoid.source(path.front().arrow))};
  for (const auto& step : path) out.push_back(system.groupoid.project(system.groupoid.compose(out.back(), step.arrow)));
  return out;
}

/// The path with these reaches, and the multipliers of `like`.
template <DiscreteSystem Sys>
Path<Sys> path_through(const Sys& system, const std::vector<ArrowOf<typename Sys::GroupoidType>>& reach,
                       const Path<Sys>& like) {
  Path<Sys> out(like.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].multipliers = like[k].multipliers;
    out[k].arrow = system.groupoid.project(system.groupoid.compose(system.groupoid.inverse(reach[k]), reach[k + 1]));
  }
  return out;
}

/// The path brought to another boundary arrow: its nodes are moved in proportion to their distance from the ends.
/// Nothing where the first objects are not joined by a short arrow.
template <DiscreteSystem Sys>
std::optional<Path<Sys>> rebased(const BoundaryProblem<Sys>& problem, const Path<Sys>& path) {
  using G = typename Sys::GroupoidType;
  const Sys& system = problem.system;
  const G& groupoid = system.groupoid;
  const std::size_t count = path.size();
  auto reach = reaches(system, path);
  const auto a =
      displacement_between<G>(groupoid, groupoid.source(path.front().arrow), groupoid.source(problem.boundary));
  if (!a) return std::nullopt;
  const ArrowOf<G> shift = groupoid.inverse(groupoid.tau(groupoid.source(path.front().arrow), *a));
  for (auto& x : reach) x = groupoid.compose(shift, x);  // now over the new first object
  const AlgebroidVector<G> end =
      groupoid.tau_inverse(groupoid.compose(groupoid.inverse(reach.back()), problem.boundary));
  for (std::size_t k = 1; k < count; ++k) {
    const double t = double(k) / double(count);
    const AlgebroidVector<G> v = (1 - t) * *a + t * end;
    reach[k] = groupoid.project(groupoid.compose(reach[k], groupoid.tau(groupoid.target(reach[k]), v)));
  }
  reach.front() = groupoid.unit(groupoid.source(problem.boundary));
  reach.back() = problem.boundary;
  return path_through(system, reach, path);
}

/// The path as far beyond `now` as `now` is beyond `before`, times `factor`, in nodes and multipliers.
template <DiscreteSystem Sys>
std::optional<Path<Sys>> extrapolated(const Sys& system, const Path<Sys>& before, const Path<Sys>& now, double factor) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  const auto a =
      displacement_between<G>(groupoid, groupoid.source(before.front().arrow), groupoid.source(now.front().arrow));
  if (!a) return std::nullopt;
  const ArrowOf<G> shift = groupoid.inverse(groupoid.tau(groupoid.source(before.front().arrow), *a));
  const auto old = reaches(system, before);
  auto reach = reaches(system, now);
  for (std::size_t k = 1; k < reach.size(); ++k) {
    const AlgebroidVector<G> v =
        factor * groupoid.tau_inverse(groupoid.compose(groupoid.inverse(groupoid.compose(shift, old[k])), reach[k]));
    reach[k] = groupoid.project(groupoid.compose(reach[k], groupoid.tau(groupoid.target(reach[k]), v)));
  }
  Path<Sys> out = path_through(system, reach, now);
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k].multipliers += factor * (now[k].multipliers - before[k].multipliers);
  return out;
}

/// Whether every node of `path` lies within `jump` times the path's extent of the prediction's, brought to the same
/// ends.
template <DiscreteSystem Sys>
bool near(const BoundaryProblem<Sys>& problem, const Path<Sys>& prediction, const Path<Sys>& path, double jump) {
  const auto based = rebased(problem, prediction);
  if (!based) return false;
  const auto& groupoid = problem.system.groupoid;
  const auto expected = reaches(problem.system, *based);
  const auto found = reaches(problem.system, path);
  double extent = 0;
  double gap = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    extent = std::max(extent, groupoid.tau_inverse(found[k]).norm());
    gap = std::max(gap, groupoid.tau_inverse(groupoid.compose(groupoid.inverse(expected[k]), found[k])).norm());
  }
  return gap <= jump * extent;
}

/// The path with its nodes displaced by random multiples of the first sine modes, the larger the later the attempt.
template <DiscreteSystem Sys> Path<Sys> bent(const BoundaryProblem<Sys>& problem, const Path<Sys>& path, int attempt) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(attempt));
  std::normal_distribution<double> normal(0, 0.01 * std::exp2(attempt));
  return displaced(problem, path, sine_modes<Sys>(path.size(), 3, [&] { return normal(generator); }), 1.0);
}

/// What `continue_to` below does, of any system.
template <DiscreteSystem Sys>
BoundarySolution<Sys> continue_to(const BoundarySolver<Sys>& solver, const BoundaryStage<Sys>& stage,
                                  const BoundarySolution<Sys>& from, const Path<Sys>& prediction) {
  const auto& [problem, steps] = stage;
  BoundarySolution<Sys> out;
  const auto based = rebased(problem, prediction);
  if (!based) {
    out.status = SolveStatus::left_domain;
    out.message = "the start moves to an object that no short arrow joins to the old one";
    out.path = prediction;
    return out;
  }
  const Path<Sys> path = based->size() == steps ? *based : resampled(problem, *based, steps);
  out = solver.solve(problem, path, /*keep_multipliers=*/true);
  int iterations = out.iterations;
  for (int bend = 1; bend <= 6 && !out.converged() && !from.kind.normal; ++bend) {
    out = solver.solve(problem, bent(problem, path, bend), /*keep_multipliers=*/false);
    iterations += out.iterations;
  }
  out.iterations = iterations;
  out.starts = from.starts;
  return out;
}

}  // namespace detail

/// The solution of a neighbouring problem as a start for this stage: its path (or a better `prediction` of the new one)
/// brought to the stage's number of arrows and boundary, and solved from there. At an abnormal extremal the path may
/// have to bend to reach its ends at all: a few bent ones are tried.
template <DiscreteSystem Sys>
BoundarySolution<Sys> continue_to(const BoundarySolver<Sys>& solver, const BoundaryStage<Sys>& stage,
                                  const BoundarySolution<Sys>& from, const Path<Sys>& prediction) {
  const Sys& system = stage.problem.system;
  const SizedBoundarySolver<Sys> sized(solver);
  return of_system(system,
                   detail::continue_to(*sized, by_sizes(stage), by_sizes(system, from), by_sizes(system, prediction)));
}

struct HomotopyOptions {
  double first_step = 0.1;      ///< of s in [0, 1]; steps grow by half after a success, halve after a failure
  double smallest_step = 1e-4;  ///< below which the homotopy gives up
  double largest_jump = 0.25;   ///< of a node from its prediction to the solution, over the extent of the path
};

/// How a homotopy ended.
struct HomotopyOutcome {
  SolveStatus status = SolveStatus::not_converged;  ///< converged: s = 1 was reached; else of the last attempt
  double reached = 0;                               ///< the largest s with a solution
  int solves = 0;
  int failures = 0;  ///< solves that failed, each halving the step
  int iterations = 0;
  bool converged() const { return status == SolveStatus::converged; }
};

/// How a homotopy ended, and with what.
template <DiscreteSystem Sys> struct HomotopyResult : HomotopyOutcome {
  BoundarySolution<Sys> solution;  ///< at `reached`
};

namespace detail {

/// What `follow` below does, of any system.
template <DiscreteSystem Sys>
HomotopyResult<Sys> follow(const BoundarySolver<Sys>& solver, const std::function<BoundaryStage<Sys>(double)>& stage,
                           BoundarySolution<Sys> start, const HomotopyOptions& options) {
  HomotopyResult<Sys> out;
  out.solution = std::move(start);
  std::optional<std::pair<double, Path<Sys>>> before;
  double step = options.first_step;
  while (out.reached < 1) {
    const double next = out.reached + step > 1 - 1e-9 ? 1.0 : out.reached + step;
    const BoundaryStage<Sys> there = stage(next);
    Path<Sys> prediction = out.solution.path;
    if (before && before->second.size() == prediction.size()) {
      const double factor = (next - out.reached) / (out.reached - before->first);
      if (auto path = extrapolated(there.problem.system, before->second, prediction, factor)) prediction = *path;
    }
    auto solution = detail::continue_to(solver, there, out.solution, prediction);
    ++out.solves;
    out.iterations += solution.iterations;
    if (solution.converged() && solution.path.size() == prediction.size() &&
        !near(there.problem, prediction, solution.path, options.largest_jump))
      solution.status = SolveStatus::left_domain;
    if (solution.converged()) {
      before = {out.reached, std::move(out.solution.path)};
      out.solution = std::move(solution);
      out.reached = next;
      step *= 1.5;
    } else {
      ++out.failures;
      step /= 2;
      if (step < options.smallest_step) {
        out.status = solution.status;
        return out;
      }
    }
  }
  out.status = SolveStatus::converged;
  return out;
}

}  // namespace detail

/// Follows a solution of stage(0) to stage(1), s -> BoundaryStage any continuous family: of parameters, boundary data,
/// step sizes. The predictor is the secant through the last two solutions. A step that fails, or whose solution lies
/// too far from its prediction to be believed on the same sheet (`left_domain`), is halved; where solutions end or turn
/// back (a fold) the homotopy gives up, with the last solution and how far it came.
template <DiscreteSystem Sys, class Stage>
HomotopyResult<Sys> follow(const BoundarySolver<Sys>& solver, const Stage& stage, const BoundarySolution<Sys>& start,
                           const HomotopyOptions& options = {}) {
  using Sized = SizedSystemOf<Sys>;
  const BoundaryStage<Sys> last = stage(1.0);
  const Sys& system = last.problem.system;
  const SizedBoundarySolver<Sys> sized(solver);
  const auto sized_stage = [&](double s) { return by_sizes(BoundaryStage<Sys>(stage(s))); };
  const HomotopyResult<Sized> found = detail::follow<Sized>(*sized, sized_stage, by_sizes(system, start), options);
  return {found, of_system(system, found.solution)};
}

}  // namespace lagroid
