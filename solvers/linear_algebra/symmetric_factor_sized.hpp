#pragma once
/// Bunch and Kaufman's factorisation P A P^T = L D L^T of a symmetric indefinite matrix whose size is known at run
/// time, and the inverse that follows from it.
///
/// The blocks of an optimal control problem have the sizes of its system; compiled once, the factorisation serves all.
///
///     SymmetricFactorSized factor(2);
///     const double a[] = {0, 1, 1, 0};  // row after row
///     factor.compute(a, 2);
///     std::vector<double> inverse(std::size_t(2 * padded(2)));
///     factor.invert(inverse.data());  // factor.negative() is 1
///
/// Requires a symmetric matrix. A singular one shows in `smallest()`, a NaN likewise, as zero; `invert` then has no
/// meaning. No allocation after construction. SymmetricFactor (symmetric_factor.hpp) is the one for sizes known to the
/// compiler. Nothing throws. Bunch and Kaufman, Math. Comp. 31 (1977).

#include <lagroid/solvers/linear_algebra/padded_rows.hpp>

#include <vector>

namespace lagroid {

class SymmetricFactorSized {
 public:
  explicit SymmetricFactorSized(int size = 0) : SymmetricFactorSized(size, padded(size)) {}
  /// With rows of the inverse so long, a multiple of eight.
  SymmetricFactorSized(int size, int row_length);

  /// Factors the matrix whose rows begin `stride` numbers after one another.
  void compute(const double* a, int stride);

  int size() const { return size_; }
  /// The number of negative eigenvalues.
  int negative() const { return negative_; }
  /// The smallest |eigenvalue| of D, times that of no scale: of the matrix as it was given.
  double smallest() const { return smallest_; }

  /// A^{-1}, in rows of padded(size) numbers or as long as was said.
  void invert(double* out) const;

 private:
  int pivot(int k);
  int eliminate_one(int k);
  int eliminate_two(int k);
  double note(double eigenvalue);
  void exchange(int i, int j);
  double* row(int i) { return rows_.data() + i * stride_; }
  const double* row(int i) const { return rows_.data() + i * stride_; }
  int size_;
  int stride_;
  std::vector<double> rows_;     // L below the diagonal
  std::vector<double> inverse_;  // of D: its diagonal
  std::vector<double> off_;      // and its (k, k + 1)
  std::vector<int> order_;
  std::vector<double> first_;  // rows of the pivot
  std::vector<double> second_;
  mutable std::vector<double> solved_;
  int negative_ = 0;
  double smallest_ = 0;
};

}  // namespace lagroid
