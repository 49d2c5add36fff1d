#pragma once
/// Row and column scales with which a matrix has rows and columns of largest entry near one, and systems solved with
/// them.
///
/// Step equations mix units: momenta, constraints, multipliers. A pivot is worth choosing, and a condition worth
/// reporting, only after the units are taken out; powers of two do it without round-off.
///
///     const Matrix<double, 2, 2> a{{1e6, 0}, {0, 1e-6}};
///     const auto b = Scaling<2>::equilibrate(a).apply(a);     // near the identity
///     const Vector<double, 2> x = solve_equilibrated(a, Vector<double, 2>(1, 1));
///
/// Entries that are not finite keep scale one. Nothing throws.
///
/// Source: Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices, RAL-TR-2001-034.

#include <lagroid/core/types.hpp>

namespace lagroid {

namespace detail {

/// Of a column-major matrix. Of run-time size: nothing of it is worth a copy for every size.
void equilibrate(const double* a, int rows, int columns, double* row_scale, double* column_scale);

/// x with a x = b, a column-major of `size` x `size`, by full pivoting after equilibration.
void solve_equilibrated(int size, const double* a, const double* b, double* x);

}  // namespace detail

/// Row and column scales, powers of two, with which a matrix has rows and columns of largest entry near one.
template <int Rows, int Columns = Rows> struct Scaling {
  Vector<double, Rows> row;
  Vector<double, Columns> column;

  Matrix<double, Rows, Columns> apply(const Matrix<double, Rows, Columns>& a) const {
    Matrix<double, Rows, Columns> out(a.rows(), a.cols());
    for (int j = 0; j < a.cols(); ++j)
      for (int i = 0; i < a.rows(); ++i) out(i, j) = row(i) * a(i, j) * column(j);
    return out;
  }

  /// Ruiz's simultaneous equilibration. Zero rows and columns keep scale one.
  static Scaling equilibrate(const Matrix<double, Rows, Columns>& a) {
    Scaling s{Vector<double, Rows>(a.rows()), Vector<double, Columns>(a.cols())};
    detail::equilibrate(a.data(), int(a.rows()), int(a.cols()), s.row.data(), s.column.data());
    return s;
  }
};

/// a^{-1} b by full pivoting after equilibration; where `a` is singular, a solution of as many equations as its rank.
template <int N> Vector<double, N> solve_equilibrated(const Matrix<double, N, N>& a, const Vector<double, N>& b) {
  Vector<double, N> x;
  detail::solve_equilibrated(N, a.data(), b.data(), x.data());
  return x;
}

}  // namespace lagroid
