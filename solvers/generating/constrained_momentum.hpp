#pragma once
/// The momentum over a state as it is reported: with the velocity that keeps the constraints there,
///
///     mu + <nu, omega(q)>,    M w - <nu, omega> = mu - mu_0,    <omega, w> + phi(e) = 0.
///
/// Between two steps half of a reaction has acted when an object is reached; without it reported momenta of constrained
/// systems would be of order one across the constraints.
///
///     const SphericalPendulum pendulum;
///     const Vector<double, 3> p = tangent_momentum(pendulum, {{0, 0, -1}, {1, 0, 0.2}});
///
/// Requires a system whose mass and constraints together are regular at the state. For systems without object or
/// nonholonomic constraints it is mu itself. The dynamics is the same with it and without it.

#include <lagroid/core/derivatives/step_equations.hpp>

namespace lagroid {

/// mu + <nu, omega(q)>, with nu such that the velocity of the result keeps the constraints at q: of the reaction at an
/// object, half has acted when it is reached. Along sections of D this is mu itself, of order two for a symmetric L and
/// phi; across D mu lacks the half and is of order one. Object constraints are kept in the same way, with dC o rho in
/// the place of omega (RATTLE's second stage). The dynamics is the same with and without it.
///
/// In terms of the unit arrow e at q, with M = -d2L/dv dw at e the mass over h, and mu_0 = (dL/dw - dL/dv) / 2 the
/// momentum at rest, zero unless L has terms linear in the velocity (a potential enters dL/dv and dL/dw alike and
/// leaves it), the displacement w of one step and the multipliers nu solve the step equations at e, linear ones:
///
///     M w - <nu, omega> = mu - mu_0,    <omega, w> + phi(e) = 0,    <dC o rho, w> = 0.
///
/// phi(e) is the affine term (a plate that turns). M need not be regular by itself: directions in which L is constant,
/// because constraints determine them, are solved with the constraints. Vakonomic phi stands in the equations with its
/// own derivatives, but its multipliers are part of the momentum and no reaction: they stay in mu.
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> constrained_momentum(const Sys& system,
                                                                 const State<typename Sys::GroupoidType>& state) {
  using E = StepEquations<Sys>;
  constexpr int n = Sys::dimension;
  constexpr int phis = Sys::arrow_constraints;
  constexpr int reactions = Nonholonomic<Sys> ? Sys::constraints : Sys::object_constraints;
  const auto unit = system.groupoid.unit(state.object);
  const HyperDualOf<Sys> lagrangian =
      system.lagrangian(system.groupoid.template seed<HyperDualOf<Sys>, End::source, End::target>(unit));
  auto d = two_sided(system, unit, Sys::Multipliers::Zero().eval());
  d.mixed = lagrangian.mixed();  // without forces that depend on the velocity
  if constexpr (Nonholonomic<Sys>)
    d.constraint_target.template topRows<phis>() = d.constraint_source.template leftCols<phis>().transpose();
  Vector<double, E::size> side = Vector<double, E::size>::Zero();
  side.template head<n>() = state.momentum - 0.5 * (lagrangian.right() - lagrangian.left());
  side.template segment<phis>(n) = -d.constraint.template head<phis>();
  const Vector<double, E::size> solution = solve_equilibrated(E::jacobian(d), side);
  return state.momentum + d.constraint_source.template rightCols<reactions>() * solution.template tail<reactions>();
}

/// The momentum over a state as it is reported: with the velocity that keeps object constraints and those of a
/// nonholonomic system (constrained_momentum); mu itself for others. Of systems with object constraints it is the one
/// in which the map is symplectic on T*C^{-1}(0).
template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType> tangent_momentum(const Sys& system,
                                                             const State<typename Sys::GroupoidType>& state) {
  if constexpr (Nonholonomic<Sys> || Sys::object_constraints > 0) {
    return constrained_momentum(system, state);
  } else {
    return state.momentum;
  }
}

}  // namespace lagroid
