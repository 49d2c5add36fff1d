#pragma once
/// Bunch and Kaufman's factorisation of a small symmetric indefinite matrix, P A P^T = L D L^T. The blocks of a KKT
/// matrix are indefinite, and the signs of D count their negative eigenvalues, which tell minima from saddles.
///
///     SymmetricFactor<2> factor;
///     factor.compute(Eigen::Matrix<double, 2, 2, Eigen::RowMajor>{{0, 1}, {1, 0}});
///     const Vector<double, 2> x = factor.solve({1, 2});  // (2, 1); factor.negative() is 1
///
/// Requires a symmetric matrix. A singular one shows in `smallest()`, a NaN likewise, as zero; `solve` then has no
/// meaning.

#include <lagroid/core/scalars/pack.hpp>
#include <lagroid/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

/// P A P^T = L D L^T with unit lower triangular L and D of 1 x 1 and 2 x 2 blocks (Bunch and Kaufman, Math. Comp. 31
/// (1977)): stable for any symmetric A, definite or not; by Sylvester's law of inertia D has as many negative
/// eigenvalues as A. Fixed size, no allocation.
template <int N> class SymmetricFactor {
 public:
  using Square = Eigen::Matrix<double, N, N, Eigen::RowMajor>;
  using Column = Vector<double, N>;

  void compute(const Square& a) {
    l_ = a;
    negative_ = 0;
    smallest_ = std::numeric_limits<double>::infinity();
    for (int i = 0; i < N; ++i) order_[i] = i;
    off_.setZero();
    for (int k = 0; k < N;) k += pivot(k);
  }

  /// The number of negative eigenvalues.
  int negative() const { return negative_; }
  /// The smallest |eigenvalue| of D.
  double smallest() const { return smallest_; }

  /// A^{-1} b.
  Column solve(const Column& b) const {
    Column x;
    for (int i = 0; i < N; ++i) x(i) = b(order_[i]);
    for (int j = 0; j < N; ++j)
      for (int i = j + 1; i < N; ++i) x(i) -= l_(i, j) * x(j);
    Column y = inverse_.cwiseProduct(x);
    for (int i = 0; i + 1 < N; ++i) {
      y(i) += off_(i) * x(i + 1);
      y(i + 1) += off_(i) * x(i);
    }
    for (int i = N; i-- > 0;)
      for (int j = 0; j < i; ++j) y(j) -= l_(i, j) * y(i);
    for (int i = 0; i < N; ++i) x(order_[i]) = y(i);
    return x;
  }

  /// s -= R^T A^{-1} R, symmetric in exact arithmetic and here. Returns A^{-1} R.
  Square subtract_from(Square& s, const Square& r) const {
    using Row = Pack<double, N>;
    std::array<Row, std::size_t(N)> y;  // L^{-1} P R
    for (int i = 0; i < N; ++i) y[i] = Row::load(r.row(order_[i]).data());
    unrolled<N>([&]<int J>() {
      for (int i = J + 1; i < N; ++i) y[i] = y[i] - l_(i, J) * y[J];
    });
    std::array<Row, std::size_t(N)> rows;
    for (int i = 0; i < N; ++i) rows[i] = Row::load(s.row(i).data());
    std::array<Row, std::size_t(N)> z;  // D^{-1} y, then L^{-T} of it
    unrolled<N>([&]<int K>() {
      z[K] = inverse_(K) * y[K];
      if constexpr (K + 1 < N) z[K] = z[K] + off_(K) * y[K + 1];
      if constexpr (K > 0) z[K] = z[K] + off_(K - 1) * y[K - 1];
      unrolled<N>([&]<int I>() { rows[I] = rows[I] - y[K][I] * z[K]; });
    });
    for (int i = 0; i < N; ++i) rows[i].store(s.row(i).data());
    unrolled<N>([&]<int J>() {
      constexpr int i = N - 1 - J;
      for (int j = 0; j < i; ++j) z[j] = z[j] - l_(i, j) * z[i];
    });
    Square solved;
    for (int i = 0; i < N; ++i) z[i].store(solved.row(order_[i]).data());
    return solved;
  }

 private:
  /// Eliminates one or two unknowns; returns how many. Before step k rows k ... N-1 of l_ hold L in columns 0 ... k-1
  /// and the rest of the matrix in the others.
  int pivot(int k) {
    if constexpr (N == 1) return eliminate_one(k);
    constexpr double growth = 0.6403882032022076;  // (1 + sqrt 17) / 8
    const double diagonal = std::abs(l_(k, k));
    int r = k;
    double below = 0;
    for (int i = k + 1; i < N; ++i)
      if (const double x = std::abs(l_(i, k)); x > below) {
        below = x;
        r = i;
      }
    // Written so that a NaN, which no pivot can mend, ends here too.
    if (k + 1 == N || !(diagonal < growth * below)) return eliminate_one(k);
    double beside = 0;  // largest off the diagonal in row r
    for (int i = k; i < N; ++i)
      if (i != r) beside = std::max(beside, std::abs(l_(r, i)));
    if (diagonal * beside >= growth * below * below) return eliminate_one(k);
    if (std::abs(l_(r, r)) >= growth * beside) {
      exchange(k, r);
      return eliminate_one(k);
    }
    exchange(k + 1, r);
    return eliminate_two(k);
  }

  int eliminate_one(int k) {
    const double d = note(l_(k, k));
    inverse_(k) = 1 / d;
    Eigen::Matrix<double, 1, N> rest = l_.row(k);
    for (int j = 0; j <= k; ++j) rest(j) = 0;
    for (int i = k + 1; i < N; ++i) {
      const double factor = l_(i, k) * inverse_(k);
      l_.row(i) -= factor * rest;
      l_(i, k) = factor;
    }
    return 1;
  }

  int eliminate_two(int k) {
    const double a = l_(k, k);
    const double b = l_(k + 1, k);
    const double c = l_(k + 1, k + 1);
    // Bunch and Kaufman take such a block only where a c - b^2 < 0, safely: one eigenvalue of each sign.
    const double determinant = a * c - b * b;
    const double large = 0.5 * (std::abs(a + c) + std::sqrt((a - c) * (a - c) + 4 * b * b));
    note(std::copysign(large, a + c));
    note(determinant / std::copysign(large, a + c));
    inverse_(k) = c / determinant;
    inverse_(k + 1) = a / determinant;
    off_(k) = -b / determinant;
    Eigen::Matrix<double, 1, N> first = l_.row(k);
    Eigen::Matrix<double, 1, N> second = l_.row(k + 1);
    for (int j = 0; j <= k + 1; ++j) first(j) = second(j) = 0;
    for (int i = k + 2; i < N; ++i) {
      const double one = inverse_(k) * l_(i, k) + off_(k) * l_(i, k + 1);
      const double two = off_(k) * l_(i, k) + inverse_(k + 1) * l_(i, k + 1);
      l_.row(i) -= one * first + two * second;
      l_(i, k) = one;
      l_(i, k + 1) = two;
    }
    l_(k + 1, k) = 0;
    return 2;
  }

  /// Counts an eigenvalue of D; a zero one is replaced by a tiny one, so that the caller sees it in `smallest`
  /// and nothing overflows.
  double note(double eigenvalue) {
    negative_ += eigenvalue < 0;
    smallest_ = std::isnan(eigenvalue) ? 0 : std::min(smallest_, std::abs(eigenvalue));
    return std::abs(eigenvalue) < 1e-300 ? 1e-300 : eigenvalue;
  }

  void exchange(int i, int j) {
    if (i == j) return;
    l_.row(i).swap(l_.row(j));
    l_.col(i).swap(l_.col(j));
    std::swap(order_[i], order_[j]);
  }

  Square l_;  // L strictly below the diagonal
  Column inverse_;
  Column off_;  // of D^{-1}: (k, k + 1)
  std::array<int, N> order_;
  int negative_ = 0;
  double smallest_ = 0;
};

}  // namespace lagroid
