#pragma once
/// Bunch and Kaufman's factorisation P A P^T = L D L^T of a symmetric indefinite matrix whose size is known at run
/// time.
///
/// The blocks of an optimal control problem have the sizes of its system; compiled once, the factorisation serves all.
///
///     SymmetricFactorSized factor(2);
///     const double a[] = {0, 1, 1, 0};  // row after row
///     factor.compute(a);
///     double b[] = {1, 2};
///     factor.solve_in_place(b, 1);  // {2, 1}; factor.negative() is 1
///
/// Requires a symmetric matrix. A singular one shows in `smallest()`, a NaN likewise, as zero; `solve_in_place` then
/// has no meaning. No allocation after construction. SymmetricFactor (symmetric_factor.hpp) is the one for sizes known
/// to the compiler. Nothing throws. Bunch and Kaufman, Math. Comp. 31 (1977).

#include <vector>

namespace lagroid {

class SymmetricFactorSized {
 public:
  explicit SymmetricFactorSized(int size = 0);

  /// Factors the matrix whose rows stand one after another.
  void compute(const double* a);

  int size() const { return size_; }
  /// The number of negative eigenvalues.
  int negative() const { return negative_; }
  /// The smallest |eigenvalue| of D, times that of no scale: of the matrix as it was given.
  double smallest() const { return smallest_; }

  /// B <- A^{-1} B, for `columns` right-hand sides whose rows stand one after another.
  void solve_in_place(double* b, int columns) const;

 private:
  int pivot(int k);
  int eliminate_one(int k);
  int eliminate_two(int k);
  double note(double eigenvalue);
  void exchange(int i, int j);
  double* row(int i) { return l_.data() + std::size_t(i) * std::size_t(size_); }
  const double* row(int i) const { return l_.data() + std::size_t(i) * std::size_t(size_); }

  int size_;
  std::vector<double> l_;        // L strictly below the diagonal
  std::vector<double> inverse_;  // of D: its diagonal
  std::vector<double> off_;      // and its (k, k + 1)
  std::vector<int> order_;
  mutable std::vector<double> permuted_;  // of one right-hand side
  int negative_ = 0;
  double smallest_ = 0;
};

}  // namespace lagroid
