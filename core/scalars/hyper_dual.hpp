#pragma once
/// The hyper-dual number x + a.v + b.w + v^T C w: a value with first derivatives in two sets of variables, v and w, and
/// the mixed second ones.
///
/// A discrete Lagrangian depends on both ends of an arrow; one evaluation gives the discrete Legendre transforms and
/// the matrix of the step.
///
///     HyperDual<double, 1, 1> x(2.0), y(3.0);
///     x.set_left(0, 1);
///     y.set_right(0, 1);
///     const double mixed = (x * x * y).mixed(0, 0);  // d2(x^2 y) / dx dy = 4
///
/// Returns exact derivatives. Comparisons are those of the values. Nothing throws.

#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/core/scalars/scalar_operators.hpp>

#include <array>
#include <type_traits>

namespace lagroid {

/// x + a.v + b.w + v^T C w with two independent sets of infinitesimals v (L of them) and w (R of them), v v = w w = 0.
///
/// Evaluating f on it gives f, df/dv, df/dw and d2f/dv dw exactly, in one pass. It has no second
/// derivatives in v alone or in w alone; seed both sets with the same directions to obtain them. Constructible from a
/// double, unlike nested first-order jets, so that formulas may contain plain constants. Each row of C lies in one
/// register where the machine has them wide enough. Like a double, indeterminate until given a value.
template <class T, int L, int R> class HyperDual : public ScalarOperators<HyperDual<T, L, R>, T> {
 public:
  using Real = T;
  static constexpr int order = 2;
  using Left = Pack<T, L>;
  using Right = Pack<T, R>;
  using Rows = std::array<Right, L>;

  T value;

  HyperDual() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> HyperDual(A x)
      : value(T(x)), left_{}, right_{}, row_{} {}  // NOLINT(google-explicit-constructor)
  LAGROID_INLINE HyperDual(T x, const Left& v, const Right& w) : value(x), left_(v), right_(w), row_{} {}

  LAGROID_INLINE static Left left_unit(int i) { return Left::unit(i); }
  LAGROID_INLINE static Right right_unit(int j) { return Right::unit(j); }
  /// x times one of these.
  LAGROID_INLINE static Left left_along(int i, const T& x) { return Left::along(i, x); }
  LAGROID_INLINE static Right right_along(int j, const T& x) { return Right::along(j, x); }

  T left(int i) const { return left_[i]; }
  T right(int j) const { return right_[j]; }
  T mixed(int i, int j) const { return row_[i][j]; }
  Vector<T, L> left() const { return left_.vector(); }
  Vector<T, R> right() const { return right_.vector(); }
  Matrix<T, L, R> mixed() const {
    Matrix<T, L, R> c;
    for (int i = 0; i < L; ++i) c.row(i) = row_[i].vector().transpose();
    return c;
  }
  void set_left(int i, T x) { left_.set(i, x); }
  void set_right(int j, T x) { right_.set(j, x); }
  void set_mixed(int i, int j, T x) { row_[i].set(j, x); }
  /// d/dw of the coefficient of v_i.
  void set_row(int i, const Right& row) { row_[i] = row; }

  /// The composition with a function of one variable, given its value and two derivatives at `value`.
  LAGROID_INLINE HyperDual chain(T f, T f1, T f2) const {
    const Left curved = f2 * left_;
    return with_rows(f, f1 * left_, f1 * right_, [&](int i) { return f1 * row_[i] + curved[i] * right_; });
  }

  LAGROID_INLINE friend HyperDual select(const MaskOf<T>& condition, const HyperDual& a, const HyperDual& b) {
    return with_rows(select(condition, a.value, b.value), select(condition, a.left_, b.left_),
                     select(condition, a.right_, b.right_),
                     [&](int i) { return select(condition, a.row_[i], b.row_[i]); });
  }
  LAGROID_INLINE friend HyperDual operator-(const HyperDual& a) {
    return with_rows(-a.value, -a.left_, -a.right_, [&](int i) { return -a.row_[i]; });
  }
  LAGROID_INLINE friend HyperDual operator+(const HyperDual& a, const HyperDual& b) {
    return with_rows(a.value + b.value, a.left_ + b.left_, a.right_ + b.right_,
                     [&](int i) { return a.row_[i] + b.row_[i]; });
  }
  LAGROID_INLINE friend HyperDual operator-(const HyperDual& a, const HyperDual& b) {
    return with_rows(a.value - b.value, a.left_ - b.left_, a.right_ - b.right_,
                     [&](int i) { return a.row_[i] - b.row_[i]; });
  }
  LAGROID_INLINE friend HyperDual operator*(const HyperDual& a, const HyperDual& b) {
    return with_rows(a.value * b.value, a.value * b.left_ + b.value * a.left_, a.value * b.right_ + b.value * a.right_,
                     [&](int i) {
                       return a.value * b.row_[i] + b.value * a.row_[i] + a.left_[i] * b.right_ + b.left_[i] * a.right_;
                     });
  }
  LAGROID_INLINE friend HyperDual operator/(const HyperDual& a, const HyperDual& b) {
    const T inverse = 1 / b.value;
    return a * b.chain(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }

  LAGROID_INLINE friend HyperDual operator+(const HyperDual& a, T b) {
    HyperDual out = a;
    out.value += b;
    return out;
  }
  LAGROID_INLINE friend HyperDual operator*(const HyperDual& a, T b) {
    return with_rows(a.value * b, b * a.left_, b * a.right_, [&](int i) { return b * a.row_[i]; });
  }
  LAGROID_INLINE friend HyperDual operator/(T a, const HyperDual& b) {
    const T inverse = 1 / b.value;
    return b.chain(a * inverse, -a * inverse * inverse, 2 * a * inverse * inverse * inverse);
  }

 private:
  template <class F> LAGROID_INLINE static HyperDual with_rows(T x, const Left& v, const Right& w, const F& row) {
    HyperDual out;
    out.value = x;
    out.left_ = v;
    out.right_ = w;
    for (int i = 0; i < L; ++i) out.row_[i] = row(i);
    return out;
  }

  Left left_;
  Right right_;
  Rows row_;
};

template <class T, int L, int R> constexpr T value_of(const HyperDual<T, L, R>& x) { return x.value; }

}  // namespace lagroid
