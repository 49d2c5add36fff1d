#pragma once
/// The first-order dual number x + d e, e^2 = 0, over any scalar: a value and one directional derivative.
///
/// Nested (Dual<Dual<double>>), it gives derivatives of any order, one direction at a time.
///
///     const Dual<double> x(2.0, 1.0);
///     const Dual<double> y = sin(x) * x;
///     const double slope = y.derivative;  // of x sin x at 2
///
/// Requires a T on which the elementary functions are defined. Comparisons are those of the values. Nothing throws.

#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/core/types.hpp>

#include <cmath>
#include <concepts>
#include <ostream>
#include <type_traits>

namespace lagroid {

/// x + d e with e^2 = 0, over any scalar T. Nested once (Dual<Dual<double>>) it gives exact second derivatives,
/// direction by direction: slow, independent of `HyperDual`, and therefore the oracle against which `HyperDual` is
/// tested. It also gives SE(3) its differentials, since se(3) is so(3) over the dual numbers.
template <class T> struct Dual {
  T value{};
  T derivative{};

  Dual() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Dual(A x)
      : value(double(x)), derivative(0.0) {}  // NOLINT(google-explicit-constructor)
  /// A constant of an inner scalar, however deep.
  template <class A>
  requires(!std::is_arithmetic_v<A> && !std::same_as<A, Dual> &&
           std::constructible_from<T, const A&>) explicit Dual(const A& x)
      : value(x), derivative(0.0) {}
  Dual(T x, T d) : value(x), derivative(d) {}

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend Dual operator+(const Dual& a) { return a; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.derivative}; }
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.derivative + b.derivative}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.derivative - b.derivative}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.derivative + a.derivative * b.value};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T quotient = a.value / b.value;
    return {quotient, (a.derivative - quotient * b.derivative) / b.value};
  }

  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend std::ostream& operator<<(std::ostream& out, const Dual& a) { return out << a.value; }
};

template <class T> constexpr auto value_of(const Dual<T>& x) { return value_of(x.value); }

template <class T> Dual<T> sqrt(const Dual<T>& x) {
  using std::sqrt;
  const T f = sqrt(x.value);
  return {f, x.derivative / (f * T(2.0))};
}
template <class T> Dual<T> exp(const Dual<T>& x) {
  using std::exp;
  const T f = exp(x.value);
  return {f, f * x.derivative};
}
template <class T> Dual<T> log(const Dual<T>& x) {
  using std::log;
  return {log(x.value), x.derivative / x.value};
}
template <class T> Dual<T> sin(const Dual<T>& x) {
  using std::cos, std::sin;
  return {sin(x.value), cos(x.value) * x.derivative};
}
template <class T> Dual<T> cos(const Dual<T>& x) {
  using std::cos, std::sin;
  return {cos(x.value), -sin(x.value) * x.derivative};
}
template <class T> Dual<T> tan(const Dual<T>& x) {
  using std::tan;
  const T t = tan(x.value);
  return {t, (T(1.0) + t * t) * x.derivative};
}
template <class T> Dual<T> asin(const Dual<T>& x) {
  using std::asin, std::sqrt;
  return {asin(x.value), x.derivative / sqrt((T(1.0) - x.value) * (T(1.0) + x.value))};
}
template <class T> Dual<T> acos(const Dual<T>& x) {
  using std::acos, std::sqrt;
  return {acos(x.value), -x.derivative / sqrt((T(1.0) - x.value) * (T(1.0) + x.value))};
}
template <class T> Dual<T> atan(const Dual<T>& x) {
  using std::atan;
  return {atan(x.value), x.derivative / (T(1.0) + x.value * x.value)};
}
template <class T> Dual<T> sinh(const Dual<T>& x) {
  using std::cosh, std::sinh;
  return {sinh(x.value), cosh(x.value) * x.derivative};
}
template <class T> Dual<T> cosh(const Dual<T>& x) {
  using std::cosh, std::sinh;
  return {cosh(x.value), sinh(x.value) * x.derivative};
}
template <class T> Dual<T> tanh(const Dual<T>& x) {
  using std::tanh;
  const T t = tanh(x.value);
  return {t, (T(1.0) - t * t) * x.derivative};
}
template <class T> Dual<T> pow(const Dual<T>& x, double p) {
  using std::pow;
  return {pow(x.value, p), p == 0 ? T(0.0) : T(p) * pow(x.value, p - 1) * x.derivative};
}
template <class T> Dual<T> abs(const Dual<T>& x) { return value_of(x) < 0 ? -x : x; }
template <class T> Dual<T> atan2(const Dual<T>& y, const Dual<T>& x) {
  using std::atan2;
  return {atan2(y.value, x.value),
          (x.value * y.derivative - y.value * x.derivative) / (x.value * x.value + y.value * y.value)};
}

template <int K, class T> Dual<T> stumpff(const Dual<T>& x) {
  return {stumpff<K>(x.value), stumpff_derivative<K>(x.value) * x.derivative};
}
template <int Order, class T> Dual<T> angle_ratio(const Dual<T>& w) {
  return {angle_ratio<Order>(w.value), angle_ratio<Order + 1>(w.value) * w.derivative};
}

/// x e: the components of x as infinitesimals.
template <class V> auto infinitesimal(const V& x) {
  using T = typename V::Scalar;
  Vector<Dual<T>, V::RowsAtCompileTime> out;
  for (int i = 0; i < out.size(); ++i) out(i) = Dual<T>(T(0.0), x(i));
  return out;
}

/// The derivative parts of x.
template <class V> auto derivative_of(const V& x) {
  using T = std::remove_cvref_t<decltype(x(0).derivative)>;
  Vector<T, V::RowsAtCompileTime> out;
  for (int i = 0; i < out.size(); ++i) out(i) = x(i).derivative;
  return out;
}

}  // namespace lagroid

template <class T> struct Eigen::NumTraits<lagroid::Dual<T>> : Eigen::NumTraits<double> {
  using Real = lagroid::Dual<T>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = 2, AddCost = 2, MulCost = 4 };
};

template <class T, class Operation> struct Eigen::ScalarBinaryOpTraits<lagroid::Dual<T>, double, Operation> {
  using ReturnType = lagroid::Dual<T>;
};
template <class T, class Operation> struct Eigen::ScalarBinaryOpTraits<double, lagroid::Dual<T>, Operation> {
  using ReturnType = lagroid::Dual<T>;
};

/// Arrays are aligned like T, which may need more than Eigen's own limit.
template <class T, int Size>
requires(Size != Eigen::Dynamic) struct Eigen::internal::compute_default_alignment<lagroid::Dual<T>, Size> {
  enum { value = 0 };
};
