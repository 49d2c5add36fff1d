#pragma once
/// The kinetic term of bodies that turn about a fixed point, and the parameters that they share:
///
///     h l(w),    l(w) = w.I w / 2,    w = tau^{-1}(g) / h.
///
/// [G] 6.1

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

namespace lagroid {

/// How a rotation g of one step becomes an angular velocity w = tau^{-1}(g) / h.
using RotationMap = Retraction;

/// The parameters that such bodies share.
template <class Sys> constexpr auto inertia_parameter(Vector<double, 3> Sys::*inertia) {
  return required(parameter("inertia", inertia, "kg m^2", "principal moments", positive));
}
template <class Sys> constexpr auto rotation_parameter(RotationMap Sys::*rotation) {
  return choice("rotation", rotation, retraction_words, "how a rotation becomes an angular velocity");
}

/// h l(tau^{-1}(g) / h), l(w) = w.I w / 2, with I the principal moments of inertia. [G] 6.1
template <class S, class T, class I>
S rotational_action(const Matrix<S, 3, 3>& g, const Vector<I, 3>& inertia, const T& h, RotationMap map) {
  const Vector<S, 3> w = SO3::retract_inverse(map, g);
  return (w(0) * w(0) * inertia(0) + w(1) * w(1) * inertia(1) + w(2) * w(2) * inertia(2)) * (0.5 / h);
}

}  // namespace lagroid
