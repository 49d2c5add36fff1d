#pragma once
/// Inverses of small matrices, one in each lane.

#include <lagroid/core/batch.hpp>
#include <lagroid/core/types.hpp>

namespace lagroid {

namespace detail {

/// Exchanges a and b in the lanes of the mask.
template <int W> LAGROID_INLINE inline void exchange(const typename Batch<W>::Mask& where, Batch<W>& a, Batch<W>& b) {
  const Batch<W> kept = a;
  a = select(where, b, a);
  b = select(where, kept, b);
}

}  // namespace detail

/// -a^{-1} in every lane. Up to size three by cofactors; beyond by Gauss-Jordan elimination in place, every lane with
/// row pivots of its own. Entries of a lane whose matrix is singular are not finite or large.
template <int W, int Size> Matrix<Batch<W>, Size, Size> negative_inverse(const Matrix<Batch<W>, Size, Size>& a) {
  using B = Batch<W>;
  Matrix<B, Size, Size> m = a;
  if constexpr (Size == 1) {
    m(0, 0) = -1.0 / a(0, 0);
  } else if constexpr (Size == 2) {
    const B scale = -1.0 / (a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0));
    m << a(1, 1) * scale, -a(0, 1) * scale, -a(1, 0) * scale, a(0, 0) * scale;
  } else if constexpr (Size == 3) {
    const auto cofactor = [&](int i, int j) {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      return a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
    };
    const B c0 = cofactor(0, 0);
    const B c1 = cofactor(0, 1);
    const B c2 = cofactor(0, 2);
    const B scale = -1.0 / (a(0, 0) * c0 + a(0, 1) * c1 + a(0, 2) * c2);
    m << c0 * scale, cofactor(1, 0) * scale, cofactor(2, 0) * scale, c1 * scale, cofactor(1, 1) * scale,
        cofactor(2, 1) * scale, c2 * scale, cofactor(1, 2) * scale, cofactor(2, 2) * scale;
  } else {
    Vector<B, Size> pivot;
    for (int k = 0; k < Size; ++k) {
      B row = double(k);
      B largest = abs(m(k, k));
      for (int i = k + 1; i < Size; ++i) {
        const B size = abs(m(i, k));
        const auto larger = size > largest;
        row = select(larger, B(i), row);
        largest = max(largest, size);
      }
      pivot(k) = row;
      for (int i = k + 1; i < Size; ++i)
        if (const auto here = row == B(i); xsimd::any(here))
          for (int j = 0; j < Size; ++j) detail::exchange(here, m(k, j), m(i, j));
      const B inverse = 1.0 / m(k, k);
      m(k, k) = 1.0;
      for (int j = 0; j < Size; ++j) m(k, j) *= inverse;
      for (int i = 0; i < Size; ++i) {
        if (i == k) continue;
        const B factor = m(i, k);
        m(i, k) = 0.0;
        for (int j = 0; j < Size; ++j) m(i, j) -= factor * m(k, j);
      }
    }
    for (int k = Size - 2; k >= 0; --k)
      for (int i = k + 1; i < Size; ++i)
        if (const auto here = pivot(k) == B(i); xsimd::any(here))
          for (int j = 0; j < Size; ++j) detail::exchange(here, m(j, k), m(j, i));
    for (int j = 0; j < Size * Size; ++j) m(j) = -m(j);
  }
  return m;
}

/// Row and column scales with which every lane's matrix has rows and columns of largest entry near one (Ruiz). Zero
/// rows and columns keep scale one.
template <int W, int Size> struct BatchScaling {
  using B = Batch<W>;
  Vector<B, Size> row;
  Vector<B, Size> column;

  static BatchScaling equilibrate(const Matrix<B, Size, Size>& a) {
    BatchScaling s;
    for (int i = 0; i < Size; ++i) s.row(i) = s.column(i) = B(1.0);
    const auto inverse_root = [](const B& x) {
      return select(x > 0.0 && x < std::numeric_limits<double>::infinity(), 1.0 / sqrt(x), B(1.0));
    };
    for (int sweep = 0; sweep < 4; ++sweep) {
      Vector<B, Size> rows;
      Vector<B, Size> columns;
      for (int i = 0; i < Size; ++i) rows(i) = columns(i) = B(0.0);
      for (int j = 0; j < Size; ++j)
        for (int i = 0; i < Size; ++i) {
          const B entry = abs(s.row(i) * a(i, j) * s.column(j));
          rows(i) = max(rows(i), entry);
          columns(j) = max(columns(j), entry);
        }
      for (int i = 0; i < Size; ++i) {
        s.row(i) *= inverse_root(rows(i));
        s.column(i) *= inverse_root(columns(i));
      }
    }
    return s;
  }
};

}  // namespace lagroid
