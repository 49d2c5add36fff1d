#pragma once
/// The distribution of a nonholonomic system.

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

/// What phi says of the distribution: omega^a = (dphi^a/dw - dphi^a/dv) / 2 at the unit of q. Where phi vanishes on
/// units the two derivatives are opposite, and D_q is what A_qG and the tangent space of {phi = 0} have in common, as
/// Iglesias et al. 2008 ask of a discrete constraint. For phi = h (a(q) v + b(q)) + O(h^3), evaluated symmetrically
/// along an arrow of velocity v, it is the distribution a(q) v = 0 whatever the affine term b, of which the difference
/// holds nothing.
template <DiscreteSystem Sys, class S = double>
Matrix<S, Sys::dimension, Sys::arrow_constraints> deduced_annihilator(
    const Sys& system, const ObjectOf<typename Sys::GroupoidType, S>& q) {
  constexpr int n = Sys::dimension;
  using J = Jet<S, 2 * n>;
  const auto unit = system.groupoid.unit(q);
  const Vector<J, Sys::arrow_constraints> phi =
      system.constraint(system.groupoid.template seed<J, End::source, End::target, 0, n>(unit));
  Matrix<S, n, Sys::arrow_constraints> omega;
  for (int a = 0; a < Sys::arrow_constraints; ++a) {
    const Vector<S, 2 * n> gradient = phi(a).gradient();
    omega.col(a) = 0.5 * (gradient.template tail<n>() - gradient.template head<n>());
  }
  return omega;
}

/// The covectors omega^1 ... omega^k in the dual of A_qG, column by column, that annihilate the virtual displacements:
/// D_q = { X in A_qG : <omega^a, X> = 0 }. The reaction of the constraints is <lambda, omega>: it does no work on
/// virtual displacements. The system's own if it has them, else those deduced from phi.
template <DiscreteSystem Sys, class S = double>
Matrix<S, Sys::dimension, Sys::arrow_constraints> annihilator(const Sys& system,
                                                              const ObjectOf<typename Sys::GroupoidType, S>& q) {
  if constexpr (HasAnnihilator<Sys>) {
    return system.annihilator(q);
  } else {
    return deduced_annihilator<Sys, S>(system, q);
  }
}

}  // namespace lagroid
