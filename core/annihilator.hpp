#pragma once
/// The distribution of a nonholonomic system.

#include <lagroid/core/jet.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

/// The covectors omega^1 ... omega^k in the dual of A_qG, column by column, that annihilate the virtual displacements:
/// D_q = { X in A_qG : <omega^a, X> = 0 }. The reaction of the constraints is <lambda, omega>: it does no work on
/// virtual displacements.
///
/// Unless the system writes them, omega^a = d/dw phi^a(tau_q(w)) at w = 0: D_q is what T_{unit(q)} {phi = const} and
/// A_qG have in common (Iglesias et al. 2008, section 3.1). For phi = h (a(q) v + b(q)) + O(h^2) along an arrow of
/// velocity v, that is the distribution a(q) v = 0, whatever the affine term b.
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::arrow_constraints> annihilator(const Sys& system,
                                                                   const ObjectOf<typename Sys::GroupoidType>& q) {
  if constexpr (HasAnnihilator<Sys>) {
    return system.annihilator(q);
  } else {
    constexpr int n = Sys::dimension;
    using J = Jet<double, n>;
    Vector<J, n> w;
    for (int i = 0; i < n; ++i) w(i) = J::variable(0, i);
    const auto& groupoid = system.groupoid;
    const Vector<J, Sys::arrow_constraints> phi =
        system.constraint(groupoid.tau(groupoid.template cast_object<J>(q), w));
    Matrix<double, n, Sys::arrow_constraints> omega;
    for (int a = 0; a < Sys::arrow_constraints; ++a) omega.col(a) = phi(a).gradient();
    return omega;
  }
}

}  // namespace lagroid
