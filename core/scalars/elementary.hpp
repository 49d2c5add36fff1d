#pragma once
/// The elementary functions of scalars with derivatives (Jet, HyperDual, SecondJet), each from its value and two
/// derivatives: f(x + v) = f + f' v + f'' v v / 2.
///
/// A formula uses them as it uses those of <cmath>, found by argument-dependent lookup.
///
///     using std::sin;  // for doubles
///     return sin(x) * sqrt(x);
///
/// Requires arguments at which the function is smooth; at others derivatives are not finite. (`abs` and `atan2` take
/// the derivative of the branch, and powers 0 and 1 are smooth at zero.) Nothing throws.

#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/core/types.hpp>

#include <cmath>
#include <concepts>

namespace lagroid {

/// A scalar with derivatives in one or more directions: `chain` composes it with a function of one variable (`Jet`,
/// `HyperDual`, `SecondJet`).
template <class X>
concept Differentiated = requires(const X& x, typename X::Real f) {
  { x.value } -> std::convertible_to<typename X::Real>;
  { x.chain(f, f, f) } -> std::same_as<X>;
};

template <Differentiated X> X sqrt(const X& x) {
  using std::sqrt;
  using T = typename X::Real;
  const T f = sqrt(x.value);
  return x.chain(f, T(0.5) / f, T(-0.25) / (f * x.value));
}
template <Differentiated X> X exp(const X& x) {
  using std::exp;
  using T = typename X::Real;
  const T f = exp(x.value);
  return x.chain(f, f, f);
}
template <Differentiated X> X log(const X& x) {
  using std::log;
  using T = typename X::Real;
  const T inverse = 1 / x.value;
  return x.chain(log(x.value), inverse, -inverse * inverse);
}
template <Differentiated X> X sin(const X& x) {
  using std::cos, std::sin;
  using T = typename X::Real;
  const T s = sin(x.value);
  return x.chain(s, cos(x.value), -s);
}
template <Differentiated X> X cos(const X& x) {
  using std::cos, std::sin;
  using T = typename X::Real;
  const T c = cos(x.value);
  return x.chain(c, -sin(x.value), -c);
}
template <Differentiated X> X tan(const X& x) {
  using std::tan;
  using T = typename X::Real;
  const T t = tan(x.value);
  const T t1 = 1 + t * t;
  return x.chain(t, t1, 2 * t * t1);
}
template <Differentiated X> X asin(const X& x) {
  using std::asin, std::sqrt;
  using T = typename X::Real;
  const T d = 1 / sqrt((1 - x.value) * (1 + x.value));
  return x.chain(asin(x.value), d, x.value * d * d * d);
}
template <Differentiated X> X acos(const X& x) {
  using std::acos, std::sqrt;
  using T = typename X::Real;
  const T d = -1 / sqrt((1 - x.value) * (1 + x.value));
  return x.chain(acos(x.value), d, x.value * d * d * d);
}
template <Differentiated X> X atan(const X& x) {
  using std::atan;
  using T = typename X::Real;
  const T d = 1 / (1 + x.value * x.value);
  return x.chain(atan(x.value), d, -2 * x.value * d * d);
}
template <Differentiated X> X sinh(const X& x) {
  using std::cosh, std::sinh;
  using T = typename X::Real;
  const T s = sinh(x.value);
  return x.chain(s, cosh(x.value), s);
}
template <Differentiated X> X cosh(const X& x) {
  using std::cosh, std::sinh;
  using T = typename X::Real;
  const T c = cosh(x.value);
  return x.chain(c, sinh(x.value), c);
}
template <Differentiated X> X tanh(const X& x) {
  using std::tanh;
  using T = typename X::Real;
  const T t = tanh(x.value);
  const T t1 = (1 - t) * (1 + t);
  return x.chain(t, t1, -2 * t * t1);
}
template <Differentiated X> X pow(const X& x, typename X::Real p) {
  using std::pow;
  using T = typename X::Real;
  // p = 0 and p = 1 have no singular derivatives at zero.
  const T f1 = select(p == 0, T(0), p * pow(x.value, p - 1));
  const T f2 = select(p == 0 || p == 1, T(0), p * (p - 1) * pow(x.value, p - 2));
  return x.chain(pow(x.value, p), f1, f2);
}
template <Differentiated X> X abs(const X& x) { return select(x.value < 0, -x, x); }
/// The angle of the point (x, y); the derivative is that of the smooth function away from the origin.
template <Differentiated X> X atan2(const X& y, const X& x) {
  using std::abs, std::atan2;
  X angle = select(abs(x.value) > abs(y.value), atan(y / x), -atan(x / y));  // right up to a constant
  angle.value = atan2(y.value, x.value);
  return angle;
}

template <int K, Differentiated X> X stumpff(const X& x) {
  using T = typename X::Real;
  const T f1 = stumpff_derivative<K>(x.value);
  const T f2 = -(stumpff_derivative<K + 1>(x.value) - K * stumpff_derivative<K + 2>(x.value)) / 2;
  return x.chain(stumpff<K>(x.value), f1, f2);
}
template <int Order, Differentiated X> X angle_ratio(const X& w) {
  static_assert(Order <= 1);
  return w.chain(angle_ratio<Order>(w.value), angle_ratio<Order + 1>(w.value), angle_ratio<Order + 2>(w.value));
}

}  // namespace lagroid
