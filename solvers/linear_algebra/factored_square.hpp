#pragma once
/// A square matrix, factored to solve with. Small sizes are compiled once, in the library.

#include <lagroid/core/types.hpp>
#include <lagroid/solvers/linear_algebra/small_sizes.hpp>

#include <Eigen/LU>

namespace lagroid {

/// P A = L U with partial pivoting, of a matrix of Size x Size.
template <int Size> class FactoredSquare {
 public:
  using Square = Matrix<double, Size, Size>;
  using Column = Eigen::Matrix<double, Size, 1, Eigen::DontAlign>;

  void compute(const Square& matrix);
  /// An estimate of 1 / (|A| |A^-1|) in the 1-norm.
  double rcond() const;
  Column solve(const Column& right) const;

 private:
  Eigen::PartialPivLU<Square> lu_;
};

template <int Size> void FactoredSquare<Size>::compute(const Square& matrix) { lu_.compute(matrix); }
template <int Size> double FactoredSquare<Size>::rcond() const { return lu_.rcond(); }
template <int Size> auto FactoredSquare<Size>::solve(const Column& right) const -> Column { return lu_.solve(right); }

LAGROID_FOR_SMALL_SIZES(extern template class FactoredSquare);

}  // namespace lagroid
