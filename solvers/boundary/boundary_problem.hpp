#pragma once
/// Boundary-value problems: given an arrow g, arrows g_1, ..., g_N with
///
///     g_1 g_2 ... g_N = g,    phi(g_k) = 0,    C(q_k) = 0,    that make  sum_k L(g_k)  stationary.
///
/// Optimal control and Lambert's problem are of this kind; fixing the product fixes both ends on any groupoid.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};  // from, to
///     const auto why = inadmissible_ends(problem);                             // nothing: the ends are possible
///     const Path<Kepler> line = resampled(problem, {{problem.boundary, {}}}, 100);
///
/// Requires a variational system whose Lagrangian does not depend on time (else it does not compile); a path has one
/// arrow at least. What is wrong with ends or paths is returned as a sentence. [G] section 5

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/derivatives/displaced_arrow.hpp>
#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/solvers/status.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// Given an arrow g of G and N, find g_1, ..., g_N in the constraint set with g_1 g_2 ... g_N = g that make
/// sum_k L(g_k) stationary ([G] section 5). Fixing the product fixes both end objects and, where G has isotropy, the
/// displacement along it: for plate-ball g = (q_0, q_N, A_0^T A_N).
template <DiscreteSystem Sys> struct BoundaryProblem {
  static_assert(!Forced<Sys>, "a forced system has no boundary values: its motions make no action stationary");
  static_assert(!Nonholonomic<Sys>,
                "a nonholonomic system has no boundary values: its motions make no action stationary");
  static_assert(
      !TimeDependent<Sys>,
      "of a system that depends on time take FixedStep<Sys> (groupoids/time_extended.hpp), whose arrows carry "
      "their times: timed_boundary makes the boundary arrow");
  Sys system;
  ArrowOf<typename Sys::GroupoidType> boundary;
};

/// A boundary-value problem together with its number of arrows.
template <DiscreteSystem Sys> struct BoundaryStage {
  BoundaryProblem<Sys> problem;
  std::size_t steps = 0;
};

/// A candidate: N composable arrows whose product is the boundary arrow, with a multiplier each.
template <DiscreteSystem Sys> using Path = std::vector<Step<Sys>>;

/// sum_k L(g_k).
template <DiscreteSystem Sys> double action(const Sys& system, const Path<Sys>& path) {
  double sum = 0;
  for (const auto& step : path) sum += system.lagrangian(step.arrow);
  return sum;
}

/// Displacements of a path's inner nodes and multipliers.
template <DiscreteSystem Sys> struct Variation {
  std::vector<Vector<double, Sys::dimension>> nodes;   ///< v_k in A_{q_k}G, q_k the target of arrow k = 0 ... N-1
  std::vector<typename Sys::Multipliers> multipliers;  ///< added to those of arrow k

  Variation() = default;
  explicit Variation(std::size_t count)
      : nodes(count, Vector<double, Sys::dimension>::Zero()), multipliers(count, Sys::Multipliers::Zero()) {}
};

/// Writes to `out` the path with node k (the target of g_k) displaced by fraction * v_k: g_k -> tau(v_{k-1})^{-1} g_k
/// tau(v_k), where the ends stay, which leaves the product as it is; and multipliers lambda + fraction * dlambda. The
/// last arrow is recomputed from the product, so that round-off does not add up. `out` must not be `path`.
template <DiscreteSystem Sys>
void displace(const BoundaryProblem<Sys>& problem, const Path<Sys>& path, const Variation<Sys>& by, double fraction,
              Path<Sys>& out) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = problem.system.groupoid;
  const std::size_t count = path.size();
  out.resize(count);
  ArrowOf<G> product = groupoid.unit(groupoid.source(problem.boundary));
  ArrowOf<G> back = product;  // tau(v_{k-1})^{-1}
  for (std::size_t k = 0; k < count; ++k) {
    out[k].multipliers = path[k].multipliers + fraction * by.multipliers[k];
    if (k + 1 == count) {
      out[k].arrow = groupoid.project(groupoid.compose(groupoid.inverse(product), problem.boundary));
      break;
    }
    const AlgebroidVector<G> v = fraction * by.nodes[k];
    displace_next(groupoid, path[k].arrow, v, back, out[k].arrow, product);
  }
}
template <DiscreteSystem Sys>
Path<Sys> displaced(const BoundaryProblem<Sys>& problem, const Path<Sys>& path, const Variation<Sys>& by,
                    double fraction) {
  Path<Sys> out;
  displace(problem, path, by, fraction, out);
  return out;
}

/// v_k = sum_j a_j sin(j pi k / N) with a_j of components draw() / j, j = 1 ... modes.
template <DiscreteSystem Sys, class Draw> Variation<Sys> sine_modes(std::size_t count, int modes, const Draw& draw) {
  Variation<Sys> out(count);
  for (int mode = 1; mode <= modes; ++mode) {
    Vector<double, Sys::dimension> amplitude;
    for (int i = 0; i < Sys::dimension; ++i) amplitude(i) = draw() / mode;
    for (std::size_t k = 0; k + 1 < count; ++k)
      out.nodes[k] += amplitude * std::sin(mode * std::numbers::pi * double(k + 1) / double(count));
  }
  return out;
}

/// The same path with another number of arrows: nodes interpolated along tau, multipliers of arrow constraints linearly
/// between the midpoints of the arrows, those of object constraints between the nodes and in proportion to the step,
/// being impulses. A starting guess for continuation in N.
template <DiscreteSystem Sys>
Path<Sys> resampled(const BoundaryProblem<Sys>& problem, const Path<Sys>& path, std::size_t count) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = problem.system.groupoid;
  const std::size_t old_count = path.size();
  std::vector<ArrowOf<G>> reach(old_count + 1, groupoid.unit(groupoid.source(problem.boundary)));
  for (std::size_t k = 0; k < old_count; ++k)
    reach[k + 1] = groupoid.project(groupoid.compose(reach[k], path[k].arrow));
  const auto node = [&](std::size_t k) {
    const double at = double(k) * double(old_count) / double(count);
    const std::size_t i = std::min(std::size_t(at), old_count - 1);
    const AlgebroidVector<G> v = (at - double(i)) * groupoid.tau_inverse(path[i].arrow);
    return ArrowOf<G>(groupoid.project(groupoid.compose(reach[i], groupoid.tau(groupoid.target(reach[i]), v))));
  };
  Path<Sys> out(count);
  ArrowOf<G> before = reach[0];
  for (std::size_t k = 0; k < count; ++k) {
    const ArrowOf<G> after = k + 1 == count ? problem.boundary : node(k + 1);
    out[k].arrow = groupoid.project(groupoid.compose(groupoid.inverse(before), after));
    before = after;
    const double ratio = double(old_count) / double(count);
    const auto multipliers = [&](double at) -> typename Sys::Multipliers {
      const std::size_t i = std::min(std::size_t(at), old_count - 1);
      const double t = at - double(i);
      return (1 - t) * path[i].multipliers + t * path[std::min(i + 1, old_count - 1)].multipliers;
    };
    out[k].multipliers = multipliers(std::clamp((double(k) + 0.5) * ratio - 0.5, 0.0, double(old_count - 1)));
    // The multiplier at the first object is no unknown, and zero.
    if constexpr (Sys::object_constraints > 0)
      out[k].multipliers.template tail<Sys::object_constraints>() =
          k == 0 ? Vector<double, Sys::object_constraints>::Zero().eval()
                 : (ratio * multipliers(std::clamp(double(k) * ratio, 1.0, double(old_count - 1)))
                                .template tail<Sys::object_constraints>())
                       .eval();
  }
  return out;
}

/// Why the ends of a problem admit no path, or nothing: what is not finite or off the object constraints by more than
/// 1e-9 of their natural size.
template <DiscreteSystem Sys> std::optional<std::string> inadmissible_ends(const BoundaryProblem<Sys>& problem) {
  const auto& groupoid = problem.system.groupoid;
  if (!groupoid.coordinates_of_arrow(problem.boundary).allFinite()) return "the boundary arrow is not finite";
  if constexpr (Sys::object_constraints > 0) {
    for (const bool at_end : {false, true}) {
      const auto q = at_end ? groupoid.target(problem.boundary) : groupoid.source(problem.boundary);
      const auto c = problem.system.object_constraint(q);
      if (!(c.cwiseAbs().maxCoeff() <= 1e-9 * (1 + groupoid.coordinates_of_object(q).squaredNorm())))
        return std::string(at_end ? "the last" : "the first") + " object does not satisfy the object constraint";
    }
  }
  return std::nullopt;
}

/// Why a path is no start for a problem, or nothing: it has no arrows, they do not compose, or their product is not the
/// boundary arrow; by more than 1e-6 of the largest coordinate met on the way. A NaN or an infinity is no reason: the
/// solver's status reports those.
template <DiscreteSystem Sys>
std::optional<std::string> inadmissible_path(const BoundaryProblem<Sys>& problem, const Path<Sys>& path) {
  const auto& groupoid = problem.system.groupoid;
  if (path.empty()) return "the path has no arrows";
  double size = groupoid.coordinates_of_arrow(problem.boundary).norm();
  const auto apart = [&](const auto& a, const auto& b) {
    size = std::max({size, a.norm(), b.norm()});
    return (a - b).norm() > 1e-6 * size;
  };
  auto product = groupoid.unit(groupoid.source(problem.boundary));
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto& arrow = path[k].arrow;
    if (apart(groupoid.coordinates_of_object(groupoid.target(product)),
              groupoid.coordinates_of_object(groupoid.source(arrow))))
      return "arrow " + std::to_string(k + 1) + " of the path does not start where " +
             (k == 0 ? "the boundary arrow starts" : "the one before it ends");
    product = groupoid.project(groupoid.multiply(product, arrow));
  }
  if (apart(groupoid.coordinates_of_arrow(product), groupoid.coordinates_of_arrow(problem.boundary)))
    return "the product of the path's arrows is not the boundary arrow";
  return std::nullopt;
}

/// How a stationary point sits among its neighbours.
struct Classification {
  bool is_minimum =
      false;             ///< the Hessian on the tangent of the constraints is positive (semi-definite if not isolated)
  bool isolated = true;  ///< false: a continuous family of solutions passes through it
  bool normal = true;    ///< false: abnormal, the constraints lose rank and the multipliers are not unique
  long negative_directions = 0;  ///< negative eigenvalues of that Hessian
};

/// How a solve of a boundary-value problem ended.
struct BoundaryOutcome {
  SolveStatus status = SolveStatus::not_converged;
  int iterations = 0;
  double residual = std::numeric_limits<double>::infinity();  ///< largest scaled component of the KKT equations
  double cost = 0;                                            ///< sum_k L(g_k)
  Classification kind;
  int starts = 0;       ///< of a multistart, those that led here; none where a way down from a saddle did
  std::string message;  ///< of a failure, where more can be said than its status
  bool converged() const { return status == SolveStatus::converged; }
};

/// A solution of a boundary-value problem, or the best iterate of a solve that failed.
template <DiscreteSystem Sys> struct BoundarySolution : BoundaryOutcome { Path<Sys> path; };

/// F- of the first arrow: the momentum at the start.
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> initial_momentum(const Sys& system, const Path<Sys>& path) {
  return legendre_minus(system, path.front()).momentum;
}
/// F+ of the last arrow: the momentum at the end.
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> final_momentum(const Sys& system, const Path<Sys>& path) {
  return legendre_plus(system, path.back()).momentum;
}

}  // namespace lagroid
