#pragma once
/// The cheapest way to turn a body that cannot turn about the axis n: on SO(3),
///
///     l(w) = w.W w / 2,    n.w = 0.
///
/// Its extremals are known in closed form where W is a multiple of the identity across n, which tests the solvers.
///
///     AttitudeControl system;
///     system.h = 0.05;
///     const BoundaryProblem<AttitudeControl> quarter_turn{system, SO3::exp(Vector<double, 3>(0, 0, 1.5))};
///
/// Requires positive weights and a unit vector n.

#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/systems/control/group_control.hpp>
#include <lagroid/systems/instances.hpp>

namespace lagroid {

/// The cheapest way to turn a body that can not turn about the axis n: l(w) = w.W w / 2, n.w = 0 on SO(3), w the
/// angular velocity in the body. A_k = A_{k-1} g_k carries body to space. With the momentum M = W w + lambda n,
///
///     w = W^{-1} (M - lambda n),    lambda = n.W^{-1} M / n.W^{-1} n,    M' = M x w.
///
/// |M| and the energy M.w / 2 are constant. Where W is c times the identity across n these are the sub-Riemannian
/// geodesics A(t) = A(0) exp(t (a + b n)) exp(-t b n), a = w(0), b = M.n / c, at cost c |a|^2 / 2 a second.
struct AttitudeControl : GroupControl<AttitudeControl, SO3, /*constraints*/ 1> {
  Vector<double, 3> weights{1, 1, 1};    ///< W = diag(weights), > 0
  Vector<double, 3> forbidden{0, 0, 1};  ///< n, a unit vector in the body

  static auto parameters() {
    return std::tuple(
        parameter("weights", &AttitudeControl::weights, "1", "three weights of the cost w.W w / 2", positive),
        direction("forbidden", &AttitudeControl::forbidden, "the forbidden axis in the body"),
        map_parameter("rotation", "how a rotation becomes an angular velocity"));
  }

  template <class S> S l(const Vector<S, 3>& w) const {
    const auto& cost = varied<S>(weights);
    return (w(0) * w(0) * cost(0) + w(1) * w(1) * cost(1) + w(2) * w(2) * cost(2)) * 0.5;
  }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& w) const {
    const auto& axis = varied<S>(forbidden);
    return Vector<S, 1>(w(0) * axis(0) + w(1) * axis(1) + w(2) * axis(2));
  }
  Control<3, 1> control(const Vector<double, 3>& mu) const {
    const Vector<double, 3> free = mu.cwiseQuotient(weights);
    const Vector<double, 3> along = forbidden.cwiseQuotient(weights);
    const double lambda = forbidden.dot(free) / forbidden.dot(along);
    return {free - lambda * along, Vector<double, 1>(lambda)};
  }

  /// Whether W is, to round-off, a multiple of the identity across n: turning about n then changes nothing.
  bool is_axial() const;
  /// Turning about the forbidden axis, where it is one: M.n is conserved.
  std::vector<Symmetry<AttitudeControl>> symmetries() const;
  std::vector<Quantity<AttitudeControl>> quantities() const;
  static std::vector<ObservedName> observed_names() {
    std::vector<ObservedName> all = GroupControl::observed_names();
    all.push_back({"axial", "axial momentum M.n"});
    return all;
  }
  template <class S> Vector<S, Eigen::Dynamic> observed(const State<SO3, S>& s, const Matrix<S, 3, 3>& attitude) const {
    const Vector<S, Eigen::Dynamic> first = GroupControl::observed(s, attitude);
    const auto& axis = varied<S>(forbidden);
    Vector<S, Eigen::Dynamic> out(first.size() + 1);
    out << first, s.momentum(0) * axis(0) + s.momentum(1) * axis(1) + s.momentum(2) * axis(2);
    return out;
  }
};

LAGROID_STEPS(extern template, AttitudeControl);
LAGROID_SOLVERS(extern template, AttitudeControl);

}  // namespace lagroid
