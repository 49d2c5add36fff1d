#pragma once
/// O(n) and SO(n), orthogonal matrices, for any n fixed when it is compiled, with the Cayley map as retraction.
///
/// Bodies of n dimensions rotate on them; SO(2) and SO(3) have files of their own, with exp.
///
///     const Vector<double, 6> v = Vector<double, 6>::Constant(0.1);  // above the diagonal, row by row
///     const Matrix<double, 4, 4> g = Orthogonal<4>::cayley(v);
///     const Vector<double, 6> again = Orthogonal<4>::cayley_inverse(g);
///
/// Requires for `cayley_inverse` a matrix without eigenvalue -1; near one, its numbers grow without bound. Nothing
/// throws.

#include <lagroid/groupoids/groups/so2.hpp>

#include <string>

namespace lagroid {

/// Arrows: orthogonal N x N matrices, of both components; the retraction reaches those without eigenvalue -1, hence
/// SO(N) from the unit. Algebra: skew-symmetric matrices by their entries above the diagonal, row by row; ad the
/// commutator. Retraction: Cayley. Memory: column-major matrix. (SO(2) and SO(3) have files of their own, with exp.)
template <int N> struct Orthogonal : MatrixGroup<Orthogonal<N>, N, N*(N - 1) / 2, Retraction::cayley> {
  static constexpr int rank = N * (N - 1) / 2;

  /// The number of the entry (r, c), r < c.
  static constexpr int index(int r, int c) { return r * N - r * (r + 1) / 2 + c - r - 1; }
  static constexpr int basis(int i, int r, int c) {
    if (r == c) return 0;
    return r < c ? (index(r, c) == i ? 1 : 0) : (index(c, r) == i ? -1 : 0);
  }
  template <class S> static Matrix<S, N, N> hat(const Vector<S, rank>& x) {
    Matrix<S, N, N> out;
    for (int c = 0; c < N; ++c)
      for (int r = 0; r < N; ++r) out(r, c) = r == c ? S(0.0) : r < c ? x(index(r, c)) : S(-x(index(c, r)));
    return out;
  }
  /// The skew-symmetric part.
  template <class S> static Vector<S, rank> vee(const Matrix<S, N, N>& x) {
    Vector<S, rank> out;
    for (int r = 0; r < N; ++r)
      for (int c = r + 1; c < N; ++c) out(index(r, c)) = (x(r, c) - x(c, r)) * 0.5;
    return out;
  }
  template <class S> static Matrix<S, N, N> inverse(const Matrix<S, N, N>& g) { return g.transpose(); }

  /// (I - X/2)^{-1} (I + X/2).
  template <class S> static Matrix<S, N, N> cayley(const Vector<S, rank>& x) {
    const Matrix<S, N, N> half = hat(x) * S(0.5);
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    return solve<S>(one - half, one + half);
  }
  /// X = 2 (g + I)^{-1} (g - I). Requires that g has no eigenvalue -1.
  template <class S> static Vector<S, rank> cayley_inverse(const Matrix<S, N, N>& g) {
    const Matrix<S, N, N> one = Matrix<S, N, N>::Identity();
    return vee(Matrix<S, N, N>(solve<S>(g + one, (g - one) * S(2.0))));
  }

  /// Turns in the planes of the first two coordinates, the next two, and so on.
  static constexpr int loops = N / 2;
  static Matrix<double, N, N> loop(const Vector<double, 0>& q, const Vector<double, rank>&,
                                   const Vector<double, loops>& turns) {
    Matrix<double, N, N> g = Matrix<double, N, N>::Identity();
    for (int i = 0; i < loops; ++i)
      g.template block<2, 2>(2 * i, 2 * i) = SO2::loop(q, Vector<double, 1>::Zero(), turns.template segment<1>(i));
    return g;
  }

  /// The nearest orthogonal matrix, by one Newton-Schulz step: exact where g is orthogonal up to round-off.
  static Matrix<double, N, N> project(const Matrix<double, N, N>& g) {
    return g * (1.5 * Matrix<double, N, N>::Identity() - 0.5 * g.transpose() * g);
  }

  static std::string name() { return "O(" + std::to_string(N) + ")"; }

 private:
  /// a^{-1} b by elimination without pivots, which none of our matrices needs: their symmetric parts are positive.
  template <class S> static Matrix<S, N, N> solve(Matrix<S, N, N> a, Matrix<S, N, N> b) {
    for (int k = 0; k < N; ++k)
      for (int i = k + 1; i < N; ++i) {
        const S factor = a(i, k) / a(k, k);
        for (int j = k + 1; j < N; ++j) a(i, j) -= factor * a(k, j);
        for (int j = 0; j < N; ++j) b(i, j) -= factor * b(k, j);
      }
    for (int k = N - 1; k >= 0; --k)
      for (int j = 0; j < N; ++j) {
        for (int i = k + 1; i < N; ++i) b(k, j) -= a(k, i) * b(i, j);
        b(k, j) /= a(k, k);
      }
    return b;
  }
};

}  // namespace lagroid
