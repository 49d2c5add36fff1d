#pragma once
/// Momenta at an object, with the velocity that keeps the constraints there.

#include <lagroid/core/two_sided.hpp>

#include <Eigen/LU>

namespace lagroid {

/// mu + <nu, omega(q)>, with nu such that the velocity of the result keeps the constraints at q: of the reaction at an
/// object, half has acted when it is reached. Along sections of D this is mu itself, of order two for a symmetric L and
/// phi; across D mu lacks the half and is of order one. The dynamics is the same with and without it.
///
/// In terms of the unit arrow e at q, with W = (-d2L/dv dw)^{-1} at e the inverse mass times h: the displacement
/// w = W (mu + <nu, omega> - mu_0) of one step keeps <omega, w> + phi(e) = 0. phi(e) is the affine term (a plate that
/// turns); mu_0 = (dL/dw - dL/dv) / 2 is the momentum at rest, zero unless L has terms linear in the velocity. A
/// potential enters dL/dv and dL/dw alike and leaves it.
///
/// Object constraints, if there are any, are kept in the same way, with dC o rho in the place of omega.
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> constrained_momentum(const Sys& system,
                                                                 const State<typename Sys::GroupoidType>& state) {
  using V = AlgebroidVector<typename Sys::GroupoidType>;
  using M = MixedOf<Sys>;
  constexpr int n = Sys::dimension;
  constexpr int k = Sys::constraints;
  const auto unit = system.groupoid.unit(state.object);
  const M lagrangian = system.lagrangian(system.groupoid.template seed<M, End::source, End::target>(unit));
  const Eigen::PartialPivLU<Matrix<double, n, n>> mass(-lagrangian.mixed());
  const V at_rest = 0.5 * (lagrangian.right() - lagrangian.left());
  const auto d = two_sided(system, unit, Sys::Multipliers::Zero().eval());
  const V w = mass.solve(state.momentum - at_rest);
  const Matrix<double, n, k> w_omega = mass.solve(d.constraint_source);
  const Matrix<double, k, n> omega = d.constraint_source.transpose();
  const Vector<double, k> nu = (omega * w_omega).partialPivLu().solve(omega * w + d.constraint);
  return state.momentum - d.constraint_source * nu;
}

/// mu with the part removed that leaves C^{-1}(0) (RATTLE's second stage): mu + nu . dC o rho with nu such that
/// dC o rho W mu = 0, where W = (-d2L/dv dw)^{-1} at the unit arrow is the inverse mass matrix up to a factor.
/// For nonholonomic and forced systems see constrained_momentum; the identity for others without object constraints.
/// The dynamics is the same with and without it; the projected momentum is the one in which the map is symplectic on
/// T*C^{-1}(0).
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> tangent_momentum(const Sys& system,
                                                             const State<typename Sys::GroupoidType>& state) {
  if constexpr (Nonholonomic<Sys> || (Forced<Sys> && Sys::arrow_constraints == 0 && Sys::object_constraints > 0)) {
    return constrained_momentum(system, state);
  } else if constexpr (Sys::object_constraints == 0) {
    return state.momentum;
  } else {
    constexpr int k = Sys::object_constraints;
    const auto d = two_sided(system, system.groupoid.unit(state.object), Sys::Multipliers::Zero().eval());
    const Matrix<double, Sys::dimension, k> normal = -d.constraint_source.template rightCols<k>();
    const Eigen::PartialPivLU<Matrix<double, Sys::dimension, Sys::dimension>> mass(-d.mixed);
    const Matrix<double, Sys::dimension, k> w_normal = mass.solve(normal);
    const Vector<double, k> nu =
        (normal.transpose() * w_normal).partialPivLu().solve(w_normal.transpose() * state.momentum);
    return state.momentum - normal * nu;
  }
}

}  // namespace lagroid
