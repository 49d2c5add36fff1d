#pragma once
/// Optimal control on a Lie groupoid G: arrows g_k with controls u_k in R^c, k = 1 ... N, whose product is given,
///
///     minimise  sum_k l(g_k, u_k, h),    phi(g_k, u_k, h) = 0,    gamma(g_k, u_k, h) <= 0,    lower <= u_k <= upper.
///
/// A problem is a class that writes l, phi and gamma as they stand in a paper; its derivatives, exact second ones
/// included, are automatic. The step h = T / N may be an unknown: then T is free.
///
///     struct Dubins : ControlSystem<Dubins, SE2, /*controls*/ 1, /*equalities*/ 3> {
///       template <class S> S cost(const Arrow<S>&, const Controls<S>&, const S& h) const { return h; }
///       template <class S> Vector<S, 3> constraint(const Arrow<S>& g, const Controls<S>& u, const S& h) const {
///         return SE2::log(g) - Vector<S, 3>(h * u(0), h, S(0.0));  // turn, ahead, aside
///       }
///     };
///
/// Requires const templates on the scalar; phi determines the arrow from its source, its control and h where controls
/// are to steer it (as many equations as the dimension of G). Members that are missing do not compile. Solve with
/// `solve_control` (solve_control.hpp).
///
/// [G] section 5 for the equality-constrained case; Ober-Bloebaum, Junge, Marsden, ESAIM COCV 17 (2011), for discrete
/// mechanics and optimal control.

#include <lagroid/core/groupoid.hpp>

#include <array>
#include <limits>
#include <vector>

namespace lagroid {

/// Base of optimal control problems. The derived class writes, as const templates on the scalar S,
///
///     S cost(const Arrow<S>& g, const Controls<S>& u, const S& h)                             l
///     Vector<S, Equalities> constraint(g, u, h)                                               phi
///     Vector<S, Inequalities> inequality(g, u, h)        if there are any                     gamma
///
/// and may write conditions that the last object is to satisfy, with `static constexpr int end_equalities`:
///
///     Vector<S, end_equalities> end_constraint(const Object<S>& q)
template <class Derived, class G, int ControlCount, int Equalities, int Inequalities = 0> struct ControlSystem {
  using GroupoidType = G;
  static constexpr int dimension = G::dimension;
  static constexpr int controls = ControlCount;
  static constexpr int equalities = Equalities;
  static constexpr int inequalities = Inequalities;
  static constexpr int end_equalities = 0;
  template <class S> using Arrow = typename G::template Arrow<S>;
  template <class S> using Object = typename G::template Object<S>;
  template <class S> using Controls = Vector<S, ControlCount>;

  [[no_unique_address]] G groupoid;
};

/// The arrows and controls of N stages, each of the same duration.
template <class Sys> struct ControlTrajectory {
  std::vector<ArrowOf<typename Sys::GroupoidType>> arrows;
  std::vector<Vector<double, Sys::controls>> controls;
  double step = 0;  ///< h

  double duration() const { return step * double(arrows.size()); }
};

/// What is to be solved: a system between two ends.
template <class Sys> struct ControlTask {
  using G = typename Sys::GroupoidType;
  static constexpr double none = std::numeric_limits<double>::infinity();
  static constexpr Vector<double, Sys::controls> all(double x) { return Vector<double, Sys::controls>::Constant(x); }

  Sys system;
  ArrowOf<G> boundary;  ///< from the first object to the last: the product of all arrows
  double duration = 1;  ///< T; the first guess of it where it is free
  bool duration_is_free = false;
  /// Components of the first and the last displacement, in A_qG, along which that end may move.
  std::array<bool, std::size_t(Sys::dimension)> free_start{};
  std::array<bool, std::size_t(Sys::dimension)> free_end{};
  Vector<double, Sys::controls> lower = all(-none);
  Vector<double, Sys::controls> upper = all(none);
};

/// Arrows tau(q, v / N) after one another, v the retraction's inverse of the boundary arrow, with controls at rest or
/// in the middle of their bounds: a trajectory to start from. The last arrow is what remains.
template <class Sys> ControlTrajectory<Sys> straight_trajectory(const ControlTask<Sys>& task, long stages) {
  const auto& groupoid = task.system.groupoid;
  using G = typename Sys::GroupoidType;
  const AlgebroidVector<G> whole = groupoid.tau_inverse(task.boundary);
  const AlgebroidVector<G> part = whole / double(stages);
  ControlTrajectory<Sys> out;
  out.step = task.duration / double(stages);
  ArrowOf<G> product = groupoid.unit(groupoid.source(task.boundary));
  for (long k = 0; k + 1 < stages; ++k) {
    out.arrows.push_back(groupoid.tau(groupoid.target(product), part));
    product = groupoid.compose(product, out.arrows.back());
  }
  out.arrows.push_back(groupoid.compose(groupoid.inverse(product), task.boundary));
  Vector<double, Sys::controls> control;
  for (int i = 0; i < Sys::controls; ++i)
    control(i) = std::isfinite(task.lower(i)) && std::isfinite(task.upper(i)) ? 0.5 * (task.lower(i) + task.upper(i))
                 : std::isfinite(task.lower(i))                               ? std::max(0.0, task.lower(i) + 1)
                 : std::isfinite(task.upper(i))                               ? std::min(0.0, task.upper(i) - 1)
                                                                              : 0.0;
  out.controls.assign(std::size_t(stages), control);
  return out;
}

}  // namespace lagroid
