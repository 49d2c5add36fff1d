#pragma once
/// The real Schur form A = U T U^T of a square matrix, in double and long double, compiled once.
///
/// T is upper triangular but for blocks of two rows, one for each pair of complex eigenvalues, which logarithms and
/// exponentials of rotations take plane by plane.
///
///     const Eigen::Matrix2d turn{{0, -1}, {1, 0}};
///     const auto [t, u] = real_schur<double>(turn);  // t(1, 0) is not zero: one block
///
/// Requires finite entries. Nothing throws.

#include <Eigen/Core>

namespace lagroid {

template <class S> struct RealSchurForm {
  Eigen::MatrixX<S> t;
  Eigen::MatrixX<S> u;
};

template <class S> RealSchurForm<S> real_schur(const Eigen::MatrixX<S>& a);

}  // namespace lagroid
