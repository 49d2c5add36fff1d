#pragma once
/// The inverse of a small matrix whose structure changes little from one call to the next.

#include <lagroid/core/types.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>

namespace lagroid {

/// Inverts matrices of a slowly varying family. Up to size four by cofactors; up to size eight by elimination of a
/// leading 4 x 4 block, itself inverted by cofactors, after a permutation of rows and columns that full pivoting chose
/// once (`choose_pivots`) and that later calls keep; beyond by LU with partial pivoting.
template <int Size> class SmallInverse {
 public:
  using Square = Matrix<double, Size, Size>;

  /// Chooses the permutation that serves matrices near `a`.
  void choose_pivots(const Square& a) {
    if constexpr (blocked) {
      const Eigen::FullPivLU<Square> lu(a);
      const auto& p = lu.permutationP().indices();
      const auto& q = lu.permutationQ().indices();
      for (int i = 0; i < Size; ++i) {
        row_of_[std::size_t(p(i))] = i;
        column_of_[std::size_t(i)] = q(i);
      }
    }
  }

  /// a^{-1}; not accurate, or not finite, where the leading block is near singular (`condition` tells).
  Square operator()(const Square& a) const {
    if constexpr (Size <= 4) {
      return a.inverse();
    } else if constexpr (blocked) {
      return by_blocks(a);
    } else {
      return a.partialPivLu().inverse();
    }
  }

  /// The product of the largest row sums of a and of its computed inverse: large or not finite where the inverse is not
  /// to be trusted.
  static double condition(const Square& a, const Square& inverse) {
    return a.cwiseAbs().rowwise().sum().maxCoeff() * inverse.cwiseAbs().rowwise().sum().maxCoeff();
  }

 private:
  static constexpr bool blocked = Size > 4 && Size <= 8;
  static constexpr int head = 4;
  static constexpr int tail = blocked ? Size - head : 1;

  Square by_blocks(const Square& matrix) const {
    Square m;
    for (int j = 0; j < Size; ++j)
      for (int i = 0; i < Size; ++i) m(i, j) = matrix(row_of_[std::size_t(i)], column_of_[std::size_t(j)]);
    const Matrix<double, head, head> a = m.template topLeftCorner<head, head>().inverse();
    const Matrix<double, head, tail> u = a * m.template topRightCorner<head, tail>();
    const Matrix<double, tail, head> t = m.template bottomLeftCorner<tail, head>() * a;
    const Matrix<double, tail, tail> schur =
        m.template bottomRightCorner<tail, tail>() - m.template bottomLeftCorner<tail, head>() * u;
    const Matrix<double, tail, tail> s = schur.inverse();
    const Matrix<double, head, tail> us = u * s;
    Square inverse;
    inverse.template topLeftCorner<head, head>() = a + us * t;
    inverse.template topRightCorner<head, tail>() = -us;
    inverse.template bottomLeftCorner<tail, head>().noalias() = -s * t;
    inverse.template bottomRightCorner<tail, tail>() = s;
    Square out;
    for (int j = 0; j < Size; ++j)
      for (int i = 0; i < Size; ++i) out(column_of_[std::size_t(i)], row_of_[std::size_t(j)]) = inverse(i, j);
    return out;
  }

  static constexpr auto identity = [] {
    std::array<int, std::size_t(Size)> order{};
    for (int i = 0; i < Size; ++i) order[std::size_t(i)] = i;
    return order;
  }();
  std::array<int, std::size_t(Size)> row_of_ = identity;     ///< position i takes this row ...
  std::array<int, std::size_t(Size)> column_of_ = identity;  ///< ... and this column
};

}  // namespace lagroid
