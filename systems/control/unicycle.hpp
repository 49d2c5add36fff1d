#pragma once
/// Steering at constant speed: on SE(2), with xi = (w, v1, v2),
///
///     l(xi) = w^2 / 2,    v1 = speed,    v2 = 0.
///
/// The cheapest paths from pose to pose are Euler's elastica.
///
///     Unicycle system;
///     system.h = 0.05;
///     const BoundaryProblem<Unicycle> aside{system, SE2::exp(Vector<double, 3>(0, 0.8, 0.3))};
///
/// Requires a positive speed.

#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/group_control.hpp>
#include <lagroid/systems/instances.hpp>

namespace lagroid {

/// A unicycle that rolls at constant speed and pays for turning: xi = (w, v1, v2) in se(2), l(xi) = w^2 / 2, v1 =
/// speed, v2 = 0. A_k = A_{k-1} g_k is the pose, position and heading. The extremals are Euler's elastica, of curvature
/// w / speed: with the momentum mu = (M, p1, p2), p the force in the body's frame,
///
///     w = M,    M' = -speed p2,    p1' = w p2,    p2' = -w p1.
///
/// |p| and the energy w^2 / 2 + speed p1 are constant. In space the force P = R p is, and so is the moment
/// M + x Py - y Px. There are no symmetries besides: none but the unit leaves v = (speed, 0) as it is.
struct Unicycle : GroupControl<Unicycle, SE2, /*constraints*/ 2> {
  double speed = 1;  ///< m/s

  static auto parameters() {
    return std::tuple(parameter("speed", &Unicycle::speed, "m/s", "forward speed", positive), map_parameter());
  }

  template <class S> S l(const Vector<S, 3>& xi) const { return xi(0) * xi(0) * 0.5; }
  template <class S> Vector<S, 2> psi(const Vector<S, 3>& xi) const { return {xi(1) - varied<S>(speed), xi(2)}; }
  Control<3, 2> control(const Vector<double, 3>& mu) const { return {{mu(0), speed, 0}, mu.tail<2>()}; }
};

LAGROID_STEPS(extern template, Unicycle);
LAGROID_SOLVERS(extern template, Unicycle);

}  // namespace lagroid
