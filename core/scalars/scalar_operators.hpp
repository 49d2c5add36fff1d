#pragma once
/// The operators of a scalar with derivatives that follow from eight of its own, and the traits by which Eigen's
/// vectors and matrices take it.
///
/// A new scalar writes its own eight, derives from ScalarOperators, and can stand wherever a double can.
///
///     class MyScalar : public ScalarOperators<MyScalar, double> { ... };
///
/// The eight are -x, x + y, x - y, x * y, x / y, x + t, x * t and t / x, t a real. Requires a member `value` too, of
/// which comparisons are made.

#include <lagroid/core/scalars/elementary.hpp>

#include <ostream>
#include <type_traits>

namespace lagroid {

/// Base of a scalar X over reals T. X supplies -x, x + y, x - y, x * y, x / y, x + t, x * t, t / x; here are the rest.
/// Comparisons are those of the values.
template <class X, class T> class ScalarOperators {
  LAGROID_INLINE X& self() { return static_cast<X&>(*this); }

 public:
  LAGROID_INLINE X& operator+=(const X& b) { return self() = self() + b; }
  LAGROID_INLINE X& operator-=(const X& b) { return self() = self() - b; }
  LAGROID_INLINE X& operator*=(const X& b) { return self() = self() * b; }
  LAGROID_INLINE X& operator/=(const X& b) { return self() = self() / b; }

  LAGROID_INLINE friend X operator+(const X& a) { return a; }
  LAGROID_INLINE friend X operator+(T a, const X& b) { return b + a; }
  LAGROID_INLINE friend X operator-(const X& a, T b) { return a + (-b); }
  LAGROID_INLINE friend X operator-(T a, const X& b) { return -b + a; }
  LAGROID_INLINE friend X operator*(T a, const X& b) { return b * a; }
  LAGROID_INLINE friend X operator/(const X& a, T b) { return a * (1 / b); }

  // Over scalars that are no plain numbers themselves, plain numbers are still constants.
  LAGROID_INLINE friend X operator+(const X& a, double b) requires(!std::is_arithmetic_v<T>) { return a + T(b); }
  LAGROID_INLINE friend X operator-(const X& a, double b) requires(!std::is_arithmetic_v<T>) { return a + T(-b); }
  LAGROID_INLINE friend X operator*(const X& a, double b) requires(!std::is_arithmetic_v<T>) { return a * T(b); }
  LAGROID_INLINE friend X operator/(const X& a, double b) requires(!std::is_arithmetic_v<T>) { return a * T(1 / b); }
  LAGROID_INLINE friend X operator+(double a, const X& b) requires(!std::is_arithmetic_v<T>) { return b + T(a); }
  LAGROID_INLINE friend X operator-(double a, const X& b) requires(!std::is_arithmetic_v<T>) { return -b + T(a); }
  LAGROID_INLINE friend X operator*(double a, const X& b) requires(!std::is_arithmetic_v<T>) { return b * T(a); }
  LAGROID_INLINE friend X operator/(double a, const X& b) requires(!std::is_arithmetic_v<T>) { return T(a) / b; }

  friend bool operator==(const X& a, const X& b) { return a.value == b.value; }
  friend auto operator<=>(const X& a, const X& b) { return a.value <=> b.value; }
  friend std::ostream& operator<<(std::ostream& out, const X& a) { return out << a.value; }
};

}  // namespace lagroid

template <lagroid::Differentiated X> struct Eigen::NumTraits<X> : Eigen::NumTraits<typename X::Real> {
  using Real = X;
  using NonInteger = X;
  using Nested = X;
  using Literal = typename X::Real;
  static constexpr int size = int(sizeof(X) / sizeof(Literal));
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = size, AddCost = size, MulCost = 4 * size };
};
template <lagroid::Differentiated X, class Operation>
struct Eigen::ScalarBinaryOpTraits<X, typename X::Real, Operation> {
  using ReturnType = X;
};
template <lagroid::Differentiated X, class Operation>
struct Eigen::ScalarBinaryOpTraits<typename X::Real, X, Operation> {
  using ReturnType = X;
};
/// Plain numbers beside scalars whose reals are none.
template <lagroid::Differentiated X, class Operation>
requires(!std::is_arithmetic_v<typename X::Real>) struct Eigen::ScalarBinaryOpTraits<X, double, Operation> {
  using ReturnType = X;
};
template <lagroid::Differentiated X, class Operation>
requires(!std::is_arithmetic_v<typename X::Real>) struct Eigen::ScalarBinaryOpTraits<double, X, Operation> {
  using ReturnType = X;
};

/// Arrays of such scalars are aligned like their registers, which may need more than Eigen's own limit.
template <lagroid::Differentiated X, int Size>
requires(Size != Eigen::Dynamic) struct Eigen::internal::compute_default_alignment<X, Size> {
  enum { value = 0 };
};
