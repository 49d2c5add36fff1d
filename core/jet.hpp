#pragma once
/// The first-order dual number with two sets of infinitesimals: the scalar behind gradients.

#include <lagroid/core/elementary.hpp>
#include <lagroid/core/lanes.hpp>

#include <ostream>
#include <type_traits>

namespace lagroid {

/// x + a.v + b.w with v v = v w = w w = 0, v of L and w of R infinitesimals: `Mixed` without its second derivatives, at
/// a fraction of the cost. Like a double, indeterminate until given a value. A groupoid's `seed` serves both.
template <class T, int L, int R> class Jet {
 public:
  using Real = T;
  static constexpr int left_size = L;
  static constexpr int right_size = R;
  static constexpr int order = 1;
  using Left = Lanes<T, L + R>;
  using Right = Lanes<T, L + R>;

  T value;

  Jet() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Jet(A x) : value(T(x)), gradient_{} {}  // NOLINT(google-explicit-constructor)
  [[gnu::always_inline]] Jet(T x, const Left& v, const Right& w) : value(x), gradient_(v + w) {}

  static Left left_unit(int i) { return Left::unit(i); }
  static Right right_unit(int j) { return Right::unit(L + j); }

  T left(int i) const { return gradient_[i]; }
  T right(int j) const { return gradient_[L + j]; }
  Vector<T, L> left() const { return gradient_.vector().template head<L>(); }
  Vector<T, R> right() const { return gradient_.vector().template tail<R>(); }
  void set_left(int i, T x) { gradient_.set(i, x); }
  void set_right(int j, T x) { gradient_.set(L + j, x); }

  /// The composition with a function of one variable, given its value and derivatives at `value`.
  [[gnu::always_inline]] Jet chain(T f, T f1, T /*f2*/) const { return {f, f1 * gradient_}; }

  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  Jet& operator/=(const Jet& b) { return *this = *this / b; }

  [[gnu::always_inline]] friend Jet operator+(const Jet& a) { return a; }
  [[gnu::always_inline]] friend Jet operator-(const Jet& a) { return {-a.value, -a.gradient_}; }
  [[gnu::always_inline]] friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.gradient_ + b.gradient_};
  }
  [[gnu::always_inline]] friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.gradient_ - b.gradient_};
  }
  [[gnu::always_inline]] friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.value * b.gradient_ + b.value * a.gradient_};
  }
  [[gnu::always_inline]] friend Jet operator/(const Jet& a, const Jet& b) {
    const T inverse = 1 / b.value;
    const T quotient = a.value * inverse;
    return {quotient, inverse * (a.gradient_ - quotient * b.gradient_)};
  }

  [[gnu::always_inline]] friend Jet operator+(const Jet& a, T b) { return {a.value + b, a.gradient_}; }
  [[gnu::always_inline]] friend Jet operator+(T a, const Jet& b) { return b + a; }
  [[gnu::always_inline]] friend Jet operator-(const Jet& a, T b) { return {a.value - b, a.gradient_}; }
  [[gnu::always_inline]] friend Jet operator-(T a, const Jet& b) { return {a - b.value, -b.gradient_}; }
  [[gnu::always_inline]] friend Jet operator*(const Jet& a, T b) { return {a.value * b, b * a.gradient_}; }
  [[gnu::always_inline]] friend Jet operator*(T a, const Jet& b) { return b * a; }
  [[gnu::always_inline]] friend Jet operator/(const Jet& a, T b) { return a * (1 / b); }
  [[gnu::always_inline]] friend Jet operator/(T a, const Jet& b) {
    const T inverse = 1 / b.value;
    return {a * inverse, (-a * inverse * inverse) * b.gradient_};
  }

  friend bool operator==(const Jet& a, const Jet& b) { return a.value == b.value; }
  friend auto operator<=>(const Jet& a, const Jet& b) { return a.value <=> b.value; }
  friend std::ostream& operator<<(std::ostream& out, const Jet& a) { return out << a.value; }

 private:
  [[gnu::always_inline]] Jet(T x, const Left& gradient) : value(x), gradient_(gradient) {}

  Lanes<T, L + R> gradient_;
};

template <class T, int L, int R> constexpr T value_of(const Jet<T, L, R>& x) { return x.value; }

}  // namespace lagroid

template <class T, int L, int R>
struct Eigen::NumTraits<lagroid::Jet<T, L, R>> : lagroid::detail::DerivativeTraits<lagroid::Jet<T, L, R>> {};
template <class T, int L, int R, class Operation>
struct Eigen::ScalarBinaryOpTraits<lagroid::Jet<T, L, R>, T, Operation> {
  using ReturnType = lagroid::Jet<T, L, R>;
};
template <class T, int L, int R, class Operation>
struct Eigen::ScalarBinaryOpTraits<T, lagroid::Jet<T, L, R>, Operation> {
  using ReturnType = lagroid::Jet<T, L, R>;
};
