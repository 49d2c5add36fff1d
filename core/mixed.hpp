#pragma once
/// The mixed second-order dual number: the scalar behind the two-sided derivative.

#include <lagroid/core/special_functions.hpp>
#include <lagroid/core/types.hpp>

#include <cmath>
#include <ostream>
#include <type_traits>

namespace lagroid {

/// x + a.v + b.w + v^T C w with two independent sets of infinitesimals v (L of them) and w (R of them), v v = w w = 0.
///
/// Evaluating f on it gives f, df/dv, df/dw and d2f/dv dw exactly, in one pass. Pure second derivatives in v or in w
/// are not carried; seed both sets with the same directions to obtain them. Constructible from a double, unlike nested
/// first-order jets, so that formulas may contain plain constants.
template <class T, int L, int R> struct Mixed {
  using Real = T;
  static constexpr int left_size = L;
  static constexpr int right_size = R;

  T value{};
  Vector<T, L> left = Vector<T, L>::Zero();
  Vector<T, R> right = Vector<T, R>::Zero();
  Matrix<T, L, R> mixed = Matrix<T, L, R>::Zero();

  Mixed() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Mixed(A x) : value(T(x)) {}  // NOLINT(google-explicit-constructor)
  template <class V, class W, class C>
  Mixed(T x, const V& v, const W& w, const C& c) : value(x), left(v), right(w), mixed(c) {}

  /// The composition with a function of one variable, given its value and two derivatives at `value`.
  Mixed chain(T f, T f1, T f2) const {
    return {f, f1 * left, f1 * right, f1 * mixed + (f2 * left) * right.transpose()};
  }

  Mixed& operator+=(const Mixed& b) { return *this = *this + b; }
  Mixed& operator-=(const Mixed& b) { return *this = *this - b; }
  Mixed& operator*=(const Mixed& b) { return *this = *this * b; }
  Mixed& operator/=(const Mixed& b) { return *this = *this / b; }

  friend Mixed operator+(const Mixed& a) { return a; }
  friend Mixed operator-(const Mixed& a) { return {-a.value, -a.left, -a.right, -a.mixed}; }
  friend Mixed operator+(const Mixed& a, const Mixed& b) {
    return {a.value + b.value, a.left + b.left, a.right + b.right, a.mixed + b.mixed};
  }
  friend Mixed operator-(const Mixed& a, const Mixed& b) {
    return {a.value - b.value, a.left - b.left, a.right - b.right, a.mixed - b.mixed};
  }
  friend Mixed operator*(const Mixed& a, const Mixed& b) {
    return {a.value * b.value, a.value * b.left + b.value * a.left, a.value * b.right + b.value * a.right,
            a.value * b.mixed + b.value * a.mixed + a.left * b.right.transpose() + b.left * a.right.transpose()};
  }
  friend Mixed operator/(const Mixed& a, const Mixed& b) {
    const T inverse = 1 / b.value;
    return a * b.chain(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }

  friend Mixed operator+(const Mixed& a, T b) { return {a.value + b, a.left, a.right, a.mixed}; }
  friend Mixed operator+(T a, const Mixed& b) { return b + a; }
  friend Mixed operator-(const Mixed& a, T b) { return {a.value - b, a.left, a.right, a.mixed}; }
  friend Mixed operator-(T a, const Mixed& b) { return {a - b.value, -b.left, -b.right, -b.mixed}; }
  friend Mixed operator*(const Mixed& a, T b) { return {a.value * b, a.left * b, a.right * b, a.mixed * b}; }
  friend Mixed operator*(T a, const Mixed& b) { return b * a; }
  friend Mixed operator/(const Mixed& a, T b) { return a * (1 / b); }
  friend Mixed operator/(T a, const Mixed& b) {
    const T inverse = 1 / b.value;
    return b.chain(a * inverse, -a * inverse * inverse, 2 * a * inverse * inverse * inverse);
  }

  friend bool operator==(const Mixed& a, const Mixed& b) { return a.value == b.value; }
  friend auto operator<=>(const Mixed& a, const Mixed& b) { return a.value <=> b.value; }
  friend std::ostream& operator<<(std::ostream& out, const Mixed& a) { return out << a.value; }
};

template <class T, int L, int R> constexpr T value_of(const Mixed<T, L, R>& x) { return x.value; }

template <class T, int L, int R> Mixed<T, L, R> sqrt(const Mixed<T, L, R>& x) {
  const T f = std::sqrt(x.value);
  return x.chain(f, T(0.5) / f, T(-0.25) / (f * x.value));
}
template <class T, int L, int R> Mixed<T, L, R> exp(const Mixed<T, L, R>& x) {
  const T f = std::exp(x.value);
  return x.chain(f, f, f);
}
template <class T, int L, int R> Mixed<T, L, R> log(const Mixed<T, L, R>& x) {
  const T inverse = 1 / x.value;
  return x.chain(std::log(x.value), inverse, -inverse * inverse);
}
template <class T, int L, int R> Mixed<T, L, R> sin(const Mixed<T, L, R>& x) {
  const T s = std::sin(x.value);
  return x.chain(s, std::cos(x.value), -s);
}
template <class T, int L, int R> Mixed<T, L, R> cos(const Mixed<T, L, R>& x) {
  const T c = std::cos(x.value);
  return x.chain(c, -std::sin(x.value), -c);
}
template <class T, int L, int R> Mixed<T, L, R> tan(const Mixed<T, L, R>& x) {
  const T t = std::tan(x.value);
  const T t1 = 1 + t * t;
  return x.chain(t, t1, 2 * t * t1);
}
template <class T, int L, int R> Mixed<T, L, R> asin(const Mixed<T, L, R>& x) {
  const T d = 1 / std::sqrt((1 - x.value) * (1 + x.value));
  return x.chain(std::asin(x.value), d, x.value * d * d * d);
}
template <class T, int L, int R> Mixed<T, L, R> acos(const Mixed<T, L, R>& x) {
  const T d = -1 / std::sqrt((1 - x.value) * (1 + x.value));
  return x.chain(std::acos(x.value), d, x.value * d * d * d);
}
template <class T, int L, int R> Mixed<T, L, R> atan(const Mixed<T, L, R>& x) {
  const T d = 1 / (1 + x.value * x.value);
  return x.chain(std::atan(x.value), d, -2 * x.value * d * d);
}
template <class T, int L, int R> Mixed<T, L, R> sinh(const Mixed<T, L, R>& x) {
  const T s = std::sinh(x.value);
  return x.chain(s, std::cosh(x.value), s);
}
template <class T, int L, int R> Mixed<T, L, R> cosh(const Mixed<T, L, R>& x) {
  const T c = std::cosh(x.value);
  return x.chain(c, std::sinh(x.value), c);
}
template <class T, int L, int R> Mixed<T, L, R> tanh(const Mixed<T, L, R>& x) {
  const T t = std::tanh(x.value);
  const T t1 = (1 - t) * (1 + t);
  return x.chain(t, t1, -2 * t * t1);
}
template <class T, int L, int R> Mixed<T, L, R> pow(const Mixed<T, L, R>& x, std::type_identity_t<T> p) {
  // p = 0 and p = 1 have no singular derivatives at zero.
  const T f1 = p == 0 ? T(0) : p * std::pow(x.value, p - 1);
  const T f2 = p == 0 || p == 1 ? T(0) : p * (p - 1) * std::pow(x.value, p - 2);
  return x.chain(std::pow(x.value, p), f1, f2);
}
template <class T, int L, int R> Mixed<T, L, R> abs(const Mixed<T, L, R>& x) { return x.value < 0 ? -x : x; }
/// The angle of the point (x, y); the derivative is that of the smooth function away from the origin.
template <class T, int L, int R> Mixed<T, L, R> atan2(const Mixed<T, L, R>& y, const Mixed<T, L, R>& x) {
  Mixed<T, L, R> angle = std::abs(x.value) > std::abs(y.value) ? atan(y / x) : -atan(x / y);  // right up to a constant
  angle.value = std::atan2(y.value, x.value);
  return angle;
}

template <int K, class T, int L, int R> Mixed<T, L, R> stumpff(const Mixed<T, L, R>& x) {
  const T f1 = stumpff_derivative<K>(x.value);
  const T f2 = -(stumpff_derivative<K + 1>(x.value) - K * stumpff_derivative<K + 2>(x.value)) / 2;
  return x.chain(stumpff<K>(x.value), f1, f2);
}
template <int Order, class T, int L, int R> Mixed<T, L, R> angle_ratio(const Mixed<T, L, R>& w) {
  static_assert(Order <= 1);
  return w.chain(angle_ratio<Order>(w.value), angle_ratio<Order + 1>(w.value), angle_ratio<Order + 2>(w.value));
}

}  // namespace lagroid

template <class T, int L, int R> struct Eigen::NumTraits<lagroid::Mixed<T, L, R>> : Eigen::NumTraits<T> {
  using Real = lagroid::Mixed<T, L, R>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = T;
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = L * R, AddCost = 2 * L * R, MulCost = 5 * L * R };
};

template <class T, int L, int R, class Operation>
struct Eigen::ScalarBinaryOpTraits<lagroid::Mixed<T, L, R>, T, Operation> {
  using ReturnType = lagroid::Mixed<T, L, R>;
};
template <class T, int L, int R, class Operation>
struct Eigen::ScalarBinaryOpTraits<T, lagroid::Mixed<T, L, R>, Operation> {
  using ReturnType = lagroid::Mixed<T, L, R>;
};
