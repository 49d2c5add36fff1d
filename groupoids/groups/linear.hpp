#pragma once
/// GL(n) and SL(n), n up to four: invertible matrices, and matrices of determinant 1, with tau = exp.
///
/// Systems of linear deformations live on them; for larger matrices there is LinearFibre.
///
///     const Vector<double, 3> v(0.1, 0.2, 0);          // sl(2): [0.1 0; 0.2 -0.1], by columns
///     const Matrix<double, 2, 2> g = SpecialLinear<2>::exp(v);
///     const Vector<double, 3> again = SpecialLinear<2>::log(g);
///
/// Requires for `log` a matrix without eigenvalues on the closed negative real axis; else it returns numbers that are
/// not numbers (NaN). Nothing throws.
///
/// Source: Denman and Beavers 1976 for the square roots in the logarithm.

#include <lagroid/groupoids/groups/matrix_group.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace lagroid {

/// What GL(n) and SL(n) have in common: `Derived` writes its basis matrices. exp is not
/// onto: a matrix with an eigenvalue on the closed negative real axis has no principal logarithm, and `log` is then not
/// a number. Memory: column-major matrix.
template <class Derived, int N, int Dimension>
struct LinearGroup : MatrixGroup<Derived, N, Dimension, Retraction::exponential> {
  static_assert(N >= 1 && N <= 4, "for larger matrices: LinearFibre");
  static constexpr int rank = Dimension;

  template <class S> static Matrix<S, N, N> hat(const Vector<S, rank>& x) {
    Matrix<S, N, N> out;
    for (int c = 0; c < N; ++c)
      for (int r = 0; r < N; ++r) {
        out(r, c) = S(0.0);
        for (int i = 0; i < rank; ++i)
          if (const int e = Derived::basis(i, r, c); e != 0) out(r, c) += double(e) * x(i);
      }
    return out;
  }
  /// Both bases count entries by columns.
  template <class S> static Vector<S, rank> vee(const Matrix<S, N, N>& x) {
    Vector<S, rank> out;
    for (int i = 0; i < rank; ++i) out(i) = x(i);
    return out;
  }
  template <class S> static Matrix<S, N, N> inverse(const Matrix<S, N, N>& g) { return g.eval().inverse(); }

  /// By scaling and squaring of exp(X) - I, so that small X keep all digits.
  template <class S> static Matrix<S, N, N> exp(const Vector<S, rank>& x) {
    Matrix<S, N, N> h = hat(x);
    int squarings = 0;
    for (double size = size_of(h); size > 0.5 && squarings < 1100; size *= 0.5) ++squarings;
    h = h * S(std::ldexp(1.0, -squarings));
    Matrix<S, N, N> power = h;
    Matrix<S, N, N> sum = h;
    for (int k = 2; k <= 15; ++k) {
      power = (power * h * S(1.0 / k)).eval();
      sum += power;
    }
    for (int k = 0; k < squarings; ++k) sum = (sum * S(2.0) + sum * sum).eval();
    return sum + Matrix<S, N, N>::Identity();
  }
  /// The principal logarithm: square roots (Denman and Beavers 1976) until the matrix is near the identity, where it is
  /// 2 artanh((r + I)^{-1} (r - I)). Near matrices without one the roots lose digits: where exp of the result is not g
  /// to 1e-11, relatively, it is not a number.
  template <class S> static Vector<S, rank> log(const Matrix<S, N, N>& g) {
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    Matrix<S, N, N> root = g;
    double scale = 2;
    for (; !(size_of(Matrix<S, N, N>(root - one)) <= 0.25); scale *= 2)
      if (scale > 1e4 || !take_square_root(root)) return not_a_number<S>();
    const Matrix<S, N, N> c = (root + one).eval().inverse() * (root - one);
    const Matrix<S, N, N> square = c * c;
    Matrix<S, N, N> power = c;
    Matrix<S, N, N> sum = c;
    for (int k = 3; k <= 19; k += 2) {
      power = (power * square).eval();
      sum += power * S(1.0 / k);
    }
    const Vector<S, rank> x = vee(Matrix<S, N, N>(sum * S(scale)));
    return size_of(Matrix<S, N, N>(exp(x) - g)) <= 1e-11 * size_of(g) ? x : not_a_number<S>();
  }

 private:
  /// The greatest sum of absolute values over the columns.
  template <class S> static double size_of(const Matrix<S, N, N>& x) {
    double out = 0;
    for (int c = 0; c < N; ++c) {
      double sum = 0;
      for (int r = 0; r < N; ++r) sum += std::abs(double(value_of(x(r, c))));
      if (!(sum <= out)) out = sum;
    }
    return out;
  }
  template <class S> static Vector<S, rank> not_a_number() {
    return Vector<S, rank>::Constant(S(std::numeric_limits<double>::quiet_NaN()));
  }
  /// False where the iteration does not settle, as where an eigenvalue lies on the negative real axis.
  template <class S> static bool take_square_root(Matrix<S, N, N>& g) {
    Matrix<S, N, N> inverse_root = Matrix<S, N, N>::Identity();
    int settled = 0;
    for (int k = 0; k < 40 && settled < 3; ++k) {  // derivatives settle after the values
      const Matrix<S, N, N> other = inverse_root.eval().inverse();
      // Scaled to equal sizes, so that very large and very small matrices settle as soon.
      const double s = settled > 0 ? 1 : std::sqrt(size_of(other) / size_of(g));
      const Matrix<S, N, N> next = (g * S(s) + other * S(1 / s)) * S(0.5);
      inverse_root = ((inverse_root * S(s) + g.eval().inverse() * S(1 / s)) * S(0.5)).eval();
      const double change = size_of(Matrix<S, N, N>(next - g));
      settled = change <= 1e-14 * size_of(next) ? settled + 1 : 0;
      g = next;
    }
    return settled > 0;
  }
};

/// Arrows: invertible N x N matrices; the retraction reaches those of positive determinant from the unit. Algebra: all
/// matrices, by columns.
template <int N> struct Linear : LinearGroup<Linear<N>, N, N * N> {
  static constexpr int basis(int i, int r, int c) { return i == r + N * c ? 1 : 0; }
  static std::string name() { return "GL(" + std::to_string(N) + ")"; }
};

/// Arrows: N x N matrices of determinant 1; the logarithm requires that. Algebra: matrices of trace 0, by columns
/// without the last entry, which is minus the sum of the others on the diagonal.
template <int N> struct SpecialLinear : LinearGroup<SpecialLinear<N>, N, N * N - 1> {
  static_assert(N >= 2);
  static constexpr int basis(int i, int r, int c) {
    if (i == r + N * c) return 1;
    return r == N - 1 && c == N - 1 && i % (N + 1) == 0 ? -1 : 0;
  }
  /// The multiple of g that has determinant 1. Requires det g > 0.
  static Matrix<double, N, N> project(const Matrix<double, N, N>& g) { return g / std::pow(g.determinant(), 1.0 / N); }
  static std::string name() { return "SL(" + std::to_string(N) + ")"; }
};

}  // namespace lagroid
