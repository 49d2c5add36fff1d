#pragma once
/// The inverse of a small matrix whose structure changes little from one call to the next, as -A^{-1} b.
///
/// A chord iteration multiplies by the inverse many times before it makes another; without a search for pivots and with
/// columns in registers both are fast.
///
///     SmallInverse<2> inverse;
///     const bool good = inverse.invert(Matrix<double, 2, 2>::Identity());
///     const auto correction = inverse.correction({1, 2});  // (-1, -2)
///
/// Requires `choose_pivots` for a matrix like those that follow, where entries are not near one or sizes are five to
/// eight. `invert` returns false where the result is not to be trusted.

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/solvers/linear_algebra/small_sizes.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>

namespace lagroid {

/// Inverts the matrices of a slowly varying family, in scaled and permuted rows and columns.
///
/// Up to size four by cofactors; up to size eight by elimination of a leading 4 x 4 block, itself inverted by
/// cofactors, after a permutation that full pivoting chose once (`choose_pivots`) and that later calls keep; beyond by
/// LU with partial pivoting.
template <int Size> class SmallInverse {
 public:
  using Square = Matrix<double, Size, Size>;
  using Column = Eigen::Matrix<double, Size, 1, Eigen::DontAlign>;

  /// Chooses scales and permutation that serve matrices near `a`.
  void choose_pivots(const Square& a, const Scaling<Size>& scaling);

  /// Inverts `a`; false where the result is not to be trusted: an entry of the scaled inverse is beyond `largest_entry`
  /// or not finite, or one of `a` is not.
  bool invert(const Square& a);

  /// Column j of -a^{-1}.
  const Pack<double, Size>& column(int j) const { return columns_[std::size_t(j)]; }
  /// -a^{-1} b.
  Column correction(const Column& b) const {
    // Two sums, for two chains of additions instead of one.
    Pack<double, Size> sum[2] = {{}, {}};
    unrolled<Size>([&]<int J>() { sum[J % 2] = sum[J % 2] + b(J) * columns_[J]; });
    const Pack<double, Size> x = sum[0] + sum[1];
    Column out;
    unrolled<Size>([&]<int I>() { out(I) = x[I]; });
    return out;
  }

  /// Visits the inverse, and the order and the scales that later ones are made with.
  void serialize(NumberArchive& archive) {
    archive(row_of_, column_of_, row_scale_, column_scale_);
    for (auto& lanes : columns_) {
      Vector<double, Size> column = lanes.vector();
      archive(column);
      lanes = Pack<double, Size>::load(column.data());
    }
  }

 private:
  static constexpr bool blocked = Size > 4 && Size <= 8;
  static constexpr int head = 4;
  static constexpr int tail = blocked ? Size - head : 1;
  static constexpr double largest_entry = 1e4;

  static Square inverse_of(const Square& m);

  using Order = std::array<int, std::size_t(Size)>;
  static constexpr Order in_order = [] {
    Order order{};
    for (int i = 0; i < Size; ++i) order[std::size_t(i)] = i;
    return order;
  }();

  static Column ones() {
    Column out;
    for (double& x : out) x = 1;
    return out;
  }

  Order row_of_ = in_order;     ///< place i takes this row of the matrix ...
  Order column_of_ = in_order;  ///< ... and this column
  Column row_scale_ = ones();
  Column column_scale_ = ones();
  std::array<Pack<double, Size>, std::size_t(Size)> columns_;  ///< of -a^{-1}
};

template <int Size> void SmallInverse<Size>::choose_pivots(const Square& a, const Scaling<Size>& scaling) {
  if constexpr (blocked) {
    const Eigen::FullPivLU<Square> lu(scaling.apply(a));
    for (int i = 0; i < Size; ++i) {
      row_of_[std::size_t(lu.permutationP().indices()(i))] = i;
      column_of_[std::size_t(i)] = lu.permutationQ().indices()(i);
    }
  }
  for (std::size_t i = 0; i < std::size_t(Size); ++i) {
    row_scale_(Eigen::Index(i)) = scaling.row(row_of_[i]);
    column_scale_(Eigen::Index(i)) = scaling.column(column_of_[i]);
  }
}

template <int Size> bool SmallInverse<Size>::invert(const Square& a) {
  Square m;
  for (int j = 0; j < Size; ++j)
    for (int i = 0; i < Size; ++i)
      m(i, j) = a(row_of_[std::size_t(i)], column_of_[std::size_t(j)]) * row_scale_(i) * column_scale_(j);
  const Square inverse = inverse_of(m);
  Square negative;  // -a^{-1}, in the order and the units of a
  for (int j = 0; j < Size; ++j)
    for (int i = 0; i < Size; ++i)
      negative(column_of_[std::size_t(i)], row_of_[std::size_t(j)]) = -inverse(i, j) * column_scale_(i) * row_scale_(j);
  for (int j = 0; j < Size; ++j) columns_[std::size_t(j)] = Pack<double, Size>::load(negative.col(j).data());
  return m.allFinite() && inverse.allFinite() && inverse.cwiseAbs().maxCoeff() < largest_entry;
}

template <int Size> auto SmallInverse<Size>::inverse_of(const Square& m) -> Square {
  if constexpr (Size <= 4) {
    return m.inverse();
  } else if constexpr (blocked) {
    const Matrix<double, head, head> a = m.template topLeftCorner<head, head>().inverse();
    const Matrix<double, head, tail> u = a.lazyProduct(m.template topRightCorner<head, tail>());
    const Matrix<double, tail, head> t = m.template bottomLeftCorner<tail, head>().lazyProduct(a);
    const Matrix<double, tail, tail> s =
        (m.template bottomRightCorner<tail, tail>() - m.template bottomLeftCorner<tail, head>().lazyProduct(u))
            .eval()
            .inverse();
    const Matrix<double, head, tail> us = u.lazyProduct(s);
    Square inverse;
    inverse.template topLeftCorner<head, head>() = a + us.lazyProduct(t);
    inverse.template topRightCorner<head, tail>() = -us;
    inverse.template bottomLeftCorner<tail, head>() = -s.lazyProduct(t);
    inverse.template bottomRightCorner<tail, tail>() = s;
    return inverse;
  } else {
    return m.partialPivLu().inverse();
  }
}

LAGROID_FOR_SMALL_SIZES(extern template class SmallInverse);

}  // namespace lagroid
