#pragma once
/// The inverse of a regular matrix of fixed size by elimination with row pivots, without memory and without a copy for
/// every size.
///
/// A part of a step may neither allocate, as core/matrices/decompositions.hpp does, nor should it make every file
/// compile a factorisation of Eigen's (docs/decisions/72_expressions_cost_their_square.md).
///
///     const Matrix<double, 2, 2> a{{0, 2}, {4, 0}};
///     const Matrix<double, 2, 2> b = regular_inverse(a);  // {{0, 0.25}, {0.5, 0}}
///
/// Requires a regular matrix; entries are not finite otherwise. Nothing throws.

#include <lagroid/core/types.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

namespace detail {

/// Of a column-major matrix of n x n, which is overwritten.
inline void regular_inverse(int n, double* a, double* inverse) {
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) inverse[i + j * n] = i == j ? 1 : 0;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a[i + k * n]) > std::abs(a[pivot + k * n])) pivot = i;
    for (int j = 0; j < n; ++j) {
      std::swap(a[k + j * n], a[pivot + j * n]);
      std::swap(inverse[k + j * n], inverse[pivot + j * n]);
    }
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i + k * n] / a[k + k * n];
      for (int j = k + 1; j < n; ++j) a[i + j * n] -= factor * a[k + j * n];
      for (int j = 0; j < n; ++j) inverse[i + j * n] -= factor * inverse[k + j * n];
    }
  }
  for (int j = 0; j < n; ++j)
    for (int i = n - 1; i >= 0; --i) {
      double sum = inverse[i + j * n];
      for (int k = i + 1; k < n; ++k) sum -= a[i + k * n] * inverse[k + j * n];
      inverse[i + j * n] = sum / a[i + i * n];
    }
}

}  // namespace detail

template <int N> Matrix<double, N, N> regular_inverse(Matrix<double, N, N> a) {
  Matrix<double, N, N> out;
  detail::regular_inverse(N, a.data(), out.data());
  return out;
}

}  // namespace lagroid
