#pragma once
/// The kinetic energy of a rigid body as the sum of two whose flows are known,
///
///     M.I^{-1} M / 2 = H_sym + H_rest,    H_sym of a symmetric top, H_rest = (1/I_a - 1/I_b) M_a^2 / 2.
///
/// The splitting steps of rigid bodies and tops are made of these flows.
///
///     const RotationSplitting kinetic(Vector<double, 3>(1, 2, 3));
///     const FlowOf<SO3, double> turn = kinetic.symmetric(0.1, Vector<double, 3>(0.1, 1, 0.1));  // t, M
///
/// Moments may carry derivatives. Requires positive ones.

#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <cmath>
#include <utility>

namespace lagroid {

/// The rotation by `angle` about the axis e_i, and what a body momentum changes by: (g^T - 1) mu, without cancellation.
template <class S> FlowOf<SO3, S> axial_turn(int i, const S& angle, const Vector<S, 3>& mu) {
  using std::cos, std::sin;
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  const S half = sin(angle * 0.5);
  const S sine = half * cos(angle * 0.5) * 2.0;
  const S versine = half * half * 2.0;
  FlowOf<SO3, S> out{Matrix<S, 3, 3>::Identity(), Vector<S, 3>::Constant(S(0.0))};
  out.arrow(j, j) = out.arrow(k, k) = 1.0 - versine;
  out.arrow(k, j) = sine;
  out.arrow(j, k) = -sine;
  out.momentum_change(j) = sine * mu(k) - versine * mu(j);
  out.momentum_change(k) = -sine * mu(j) - versine * mu(k);
  return out;
}

/// M.I^{-1} M / 2 = H_sym + H_rest with b the middle one of the principal moments, a that of the others whose inverse
/// is nearer to its own, and c the third:
///
///     H_sym = |M|^2 / (2 I_b) + (1/I_c - 1/I_b) M_c^2 / 2    a symmetric top: with w = (1/I_c - 1/I_b) M_c,
///                                                            M = exp(-t w e_c) M_0,
///                                                            g = exp(t M_0 / I_b) exp(t w e_c)
///     H_rest = (1/I_a - 1/I_b) M_a^2 / 2                     a rotation about e_a
///
/// A symmetric body is all H_sym, and keeps M_c. (The rotations about three axes, of M_i^2 / (2 I_i), turn further and
/// err more; subtracting a multiple of |M|^2 costs nothing, for it commutes with all. Fasso, J. Comput. Phys. 189
/// (2003) 527, compares such splittings.)
template <class P> class BasicRotationSplitting {
 public:
  explicit BasicRotationSplitting(const Vector<P, 3>& inertia)
      : inverse_(P(1.0) / inertia(0), P(1.0) / inertia(1), P(1.0) / inertia(2)) {
    if (inverse(a_) < inverse(b_)) std::swap(a_, b_);
    if (inverse(b_) < inverse(c_)) std::swap(b_, c_);
    if (inverse(a_) < inverse(b_)) std::swap(a_, b_);
    if (inverse(a_) - inverse(b_) > inverse(b_) - inverse(c_)) std::swap(a_, c_);
  }

  /// Whether nothing is left for the rest.
  bool is_symmetric() const { return inverse(a_) == inverse(b_); }

  template <class T, class S> FlowOf<SO3, S> symmetric(const T& t, const Vector<S, 3>& mu) const {
    FlowOf<SO3, S> out = axial_turn(c_, S(mu(c_) * constant<S>(t * (inverse_(c_) - inverse_(b_)))), mu);
    out.arrow = SO3::multiply(SO3::exp(Vector<S, 3>(mu * constant<S>(t * inverse_(b_)))), out.arrow);
    return out;
  }
  template <class T, class S> FlowOf<SO3, S> rest(const T& t, const Vector<S, 3>& mu) const {
    return axial_turn(a_, S(mu(a_) * constant<S>(t * (inverse_(a_) - inverse_(b_)))), mu);
  }

 private:
  double inverse(int i) const { return value_of(inverse_(i)); }

  Vector<P, 3> inverse_;
  int a_ = 0;
  int b_ = 1;
  int c_ = 2;
};
using RotationSplitting = BasicRotationSplitting<double>;

}  // namespace lagroid
