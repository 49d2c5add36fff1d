#pragma once
/// The distribution D of a nonholonomic system, by the covectors that annihilate it: D_q = { X in A_qG : <omega^a(q),
/// X> = 0 }.
///
/// The reaction of the constraints is <lambda, omega>; it does no work on virtual displacements, which lie in D.
///
///     const auto omega = annihilator(system, q);  // n x k, column a is omega^a
///
/// Requires a system with arrow constraints phi; where it has no `annihilator` of its own, phi must vanish on units.
/// Returns an n x k matrix, over the scalar of q where the form is deduced from phi. Nothing throws.
///
/// Source: Iglesias, Marrero, Martin de Diego, Martinez, J. Nonlinear Sci. 18, 2008, for discrete constraints on
/// groupoids.

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

/// The covectors that follow from phi: omega^a = (dphi^a/dw - dphi^a/dv) / 2 at the unit of q. Where phi vanishes on
/// units the two derivatives are opposite, and D_q is the intersection of A_qG and the tangent space of {phi = 0}, as
/// Iglesias et al. 2008 require of a discrete constraint. For phi = h (a(q) v + b(q)) + O(h^3), evaluated symmetrically
/// along an arrow of velocity v, it is the distribution a(q) v = 0 for any affine term b, which cancels in the
/// difference.
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
