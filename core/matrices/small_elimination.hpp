#pragma once
/// A X = B for small square matrices over any scalar, by elimination with partial pivoting, and det A.
///
/// Written entry by entry: Eigen's factorisations over scalars with derivatives cost the compiler seconds each.
///
///     Matrix<double, 2, 2> a{{0, 2}, {1, 0}};
///     Vector<double, 2> b(4, 3);
///     const double determinant = eliminate(a, b);  // -2; b is now (3, 2)
///
/// Requires entries that are finite; `b` of any number of columns. On return `b` is the solution and `a` is spent;
/// where the determinant is zero, `b` is not to be used. Nothing throws.

#include <lagroid/core/types.hpp>

#include <cmath>
#include <utility>

namespace lagroid {

template <class S, int N, int Columns> double eliminate(Matrix<S, N, N>& a, Matrix<S, N, Columns>& b) {
  const int columns = int(b.cols());
  double determinant = 1;
  for (int k = 0; k < N; ++k) {
    int pivot = k;
    for (int i = k + 1; i < N; ++i)
      if (std::abs(double(value_of(a(i, k)))) > std::abs(double(value_of(a(pivot, k))))) pivot = i;
    const double size = double(value_of(a(pivot, k)));
    determinant *= pivot == k ? size : -size;
    if (size == 0) return 0;
    if (pivot != k) {
      for (int j = k; j < N; ++j) std::swap(a(k, j), a(pivot, j));
      for (int j = 0; j < columns; ++j) std::swap(b(k, j), b(pivot, j));
    }
    for (int i = k + 1; i < N; ++i) {
      const S factor = a(i, k) / a(k, k);
      for (int j = k + 1; j < N; ++j) a(i, j) -= factor * a(k, j);
      for (int j = 0; j < columns; ++j) b(i, j) -= factor * b(k, j);
    }
  }
  for (int k = N; k-- > 0;)
    for (int j = 0; j < columns; ++j) {
      S sum = b(k, j);
      for (int i = k + 1; i < N; ++i) sum -= a(k, i) * b(i, j);
      b(k, j) = sum / a(k, k);
    }
  return determinant;
}

}  // namespace lagroid
