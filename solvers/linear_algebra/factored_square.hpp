#pragma once
/// A square matrix factored to solve with, P A = L U with partial pivoting. It is Eigen's, compiled once in the library
/// for the sizes of step equations, which Eigen's templates would compile anew in every file.
///
///     FactoredSquare<2> lu;
///     lu.compute(Matrix<double, 2, 2>::Identity());
///     const auto x = lu.solve({1, 2});  // sensible where lu.rcond() is not tiny

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
