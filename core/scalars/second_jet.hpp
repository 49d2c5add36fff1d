#pragma once
/// The second-order jet x + g.v + v^T H v / 2, v v v = 0: a value with gradient and symmetric Hessian in N variables.
///
/// On a group, one evaluation along the arrow's frame gives every second derivative at both ends.
///
///     const auto x = SecondJet<double, 2>::variable(3.0, 0);
///     const auto y = SecondJet<double, 2>::variable(4.0, 1);
///     const double mixed = (x * x * y).hessian(0, 1);  // 2 x = 6
///
/// Returns exact derivatives. Comparisons are those of the values. Nothing throws.

#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/core/scalars/scalar_operators.hpp>

#include <array>
#include <type_traits>

namespace lagroid {

/// x + g.v + v^T H v / 2 in N infinitesimals v with v v v = 0: a Taylor polynomial. The rows of H lie side by side in
/// registers; all of them are kept, since half of a row saves nothing there. Like a double, indeterminate until given a
/// value.
template <class T, int N> class SecondJet : public ScalarOperators<SecondJet<T, N>, T> {
 public:
  using Real = T;
  using Row = Pack<T, N>;
  static constexpr int order = 2;

  T value;

  SecondJet() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> SecondJet(A x)  // NOLINT(google-explicit-constructor)
      : value(T(x)), gradient_{}, rows_{} {}
  LAGROID_INLINE SecondJet(T x, const Row& gradient) : value(x), gradient_(gradient), rows_{} {}

  /// The i-th variable, of value x.
  static SecondJet variable(T x, int i) { return {x, Row::unit(i)}; }
  /// x times the i-th infinitesimal.
  static Row along(int i, const T& x) { return Row::along(i, x); }

  T gradient(int i) const { return gradient_[i]; }
  T hessian(int i, int j) const { return rows_[i][j]; }
  Vector<T, N> gradient() const { return gradient_.vector(); }
  Matrix<T, N, N> hessian() const {
    Matrix<T, N, N> h;
    for (int i = 0; i < N; ++i) h.row(i) = rows_[i].vector().transpose();
    return h;
  }
  /// Row i of H; the caller sets them all, symmetric.
  void set_row(int i, const Row& row) { rows_[i] = row; }

  /// The composition with a function of one variable, given its value and two derivatives at `value`.
  LAGROID_INLINE SecondJet chain(T f, T f1, T f2) const {
    const Row curved = f2 * gradient_;
    return with_rows(f, f1 * gradient_, [&](int i) { return f1 * rows_[i] + curved[i] * gradient_; });
  }

  LAGROID_INLINE friend SecondJet select(const MaskOf<T>& condition, const SecondJet& a, const SecondJet& b) {
    return with_rows(select(condition, a.value, b.value), select(condition, a.gradient_, b.gradient_),
                     [&](int i) { return select(condition, a.rows_[i], b.rows_[i]); });
  }
  LAGROID_INLINE friend SecondJet operator-(const SecondJet& a) {
    return with_rows(-a.value, -a.gradient_, [&](int i) { return -a.rows_[i]; });
  }
  LAGROID_INLINE friend SecondJet operator+(const SecondJet& a, const SecondJet& b) {
    return with_rows(a.value + b.value, a.gradient_ + b.gradient_, [&](int i) { return a.rows_[i] + b.rows_[i]; });
  }
  LAGROID_INLINE friend SecondJet operator-(const SecondJet& a, const SecondJet& b) {
    return with_rows(a.value - b.value, a.gradient_ - b.gradient_, [&](int i) { return a.rows_[i] - b.rows_[i]; });
  }
  LAGROID_INLINE friend SecondJet operator*(const SecondJet& a, const SecondJet& b) {
    return with_rows(a.value * b.value, a.value * b.gradient_ + b.value * a.gradient_, [&](int i) {
      return a.value * b.rows_[i] + b.value * a.rows_[i] + a.gradient_[i] * b.gradient_ + b.gradient_[i] * a.gradient_;
    });
  }
  friend SecondJet operator/(const SecondJet& a, const SecondJet& b) {
    const T inverse = 1 / b.value;
    return a * b.chain(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }

  friend SecondJet operator+(const SecondJet& a, T b) {
    SecondJet out = a;
    out.value += b;
    return out;
  }
  LAGROID_INLINE friend SecondJet operator*(const SecondJet& a, T b) {
    return with_rows(a.value * b, b * a.gradient_, [&](int i) { return b * a.rows_[i]; });
  }
  friend SecondJet operator/(T a, const SecondJet& b) {
    const T inverse = 1 / b.value;
    return b.chain(a * inverse, -a * inverse * inverse, 2 * a * inverse * inverse * inverse);
  }

 private:
  template <class F> LAGROID_INLINE static SecondJet with_rows(T x, const Row& gradient, const F& row) {
    SecondJet out;
    out.value = x;
    out.gradient_ = gradient;
    for (int i = 0; i < N; ++i) out.rows_[i] = row(i);
    return out;
  }

  Row gradient_;
  std::array<Row, std::size_t(N)> rows_;
};

template <class T, int N> constexpr T value_of(const SecondJet<T, N>& x) { return x.value; }

}  // namespace lagroid
