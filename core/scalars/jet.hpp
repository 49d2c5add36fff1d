#pragma once
/// The first-order jet x + a.v, v v = 0: a value with its gradient in N variables.
///
/// It is the scalar behind gradients: one evaluation gives all N derivatives, in vector registers.
///
///     const auto x = Jet<double, 2>::variable(3.0, 0);
///     const auto y = Jet<double, 2>::variable(4.0, 1);
///     const Vector<double, 2> gradient = sqrt(x * x + y * y).gradient();  // (0.6, 0.8)
///
/// Returns exact derivatives. Comparisons are those of the values. Nothing throws.

#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/core/scalars/scalar_operators.hpp>

#include <type_traits>

namespace lagroid {

/// x + a.v with N infinitesimals v, v v = 0: `HyperDual` without its second derivatives, at a fraction of the cost.
/// Like a double, indeterminate until given a value. A groupoid's `seed` serves both; to it the left infinitesimals and
/// the right ones are the same set.
template <class T, int N> class Jet : public ScalarOperators<Jet<T, N>, T> {
 public:
  using Real = T;
  static constexpr int size = N;
  static constexpr int order = 1;
  using Left = Pack<T, N>;
  using Right = Pack<T, N>;

  T value;

  Jet() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Jet(A x) : value(T(x)), gradient_{} {}  // NOLINT(google-explicit-constructor)
  LAGROID_INLINE Jet(T x, const Left& v, const Right& w) : value(x), gradient_(v + w) {}
  LAGROID_INLINE Jet(T x, const Left& gradient) : value(x), gradient_(gradient) {}

  /// The i-th variable, of value x.
  LAGROID_INLINE static Jet variable(T x, int i) { return {x, Left::unit(i)}; }
  LAGROID_INLINE static Left left_unit(int i) { return Left::unit(i); }
  LAGROID_INLINE static Right right_unit(int i) { return Right::unit(i); }
  /// x times one of these.
  LAGROID_INLINE static Left along(int i, const T& x) { return Left::along(i, x); }
  LAGROID_INLINE static Left left_along(int i, const T& x) { return Left::along(i, x); }
  LAGROID_INLINE static Right right_along(int i, const T& x) { return Right::along(i, x); }

  T gradient(int i) const { return gradient_[i]; }
  Vector<T, N> gradient() const { return gradient_.vector(); }
  void set_left(int i, T x) { gradient_.set(i, x); }
  void set_right(int i, T x) { gradient_.set(i, x); }

  /// The composition with a function of one variable, given its value and derivatives at `value`.
  LAGROID_INLINE Jet chain(T f, T f1, T /*f2*/) const { return {f, f1 * gradient_}; }

  LAGROID_INLINE friend Jet select(const MaskOf<T>& condition, const Jet& a, const Jet& b) {
    return {select(condition, a.value, b.value), select(condition, a.gradient_, b.gradient_)};
  }
  LAGROID_INLINE friend Jet operator-(const Jet& a) { return {-a.value, -a.gradient_}; }
  LAGROID_INLINE friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.gradient_ + b.gradient_};
  }
  LAGROID_INLINE friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.gradient_ - b.gradient_};
  }
  LAGROID_INLINE friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.value * b.gradient_ + b.value * a.gradient_};
  }
  LAGROID_INLINE friend Jet operator/(const Jet& a, const Jet& b) {
    const T inverse = 1 / b.value;
    const T quotient = a.value * inverse;
    return {quotient, inverse * (a.gradient_ - quotient * b.gradient_)};
  }

  LAGROID_INLINE friend Jet operator+(const Jet& a, T b) { return {a.value + b, a.gradient_}; }
  LAGROID_INLINE friend Jet operator*(const Jet& a, T b) { return {a.value * b, b * a.gradient_}; }
  LAGROID_INLINE friend Jet operator/(T a, const Jet& b) {
    const T inverse = 1 / b.value;
    return {a * inverse, (-a * inverse * inverse) * b.gradient_};
  }

 private:
  Pack<T, N> gradient_;
};

template <class T, int N> constexpr T value_of(const Jet<T, N>& x) { return x.value; }

}  // namespace lagroid
