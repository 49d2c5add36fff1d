#pragma once
/// Factorisations of matrices whose size is known at run time, compiled once, in the library.
///
/// Eigen compiles a factorisation anew for every size and in every file, and g++ takes a time that grows with the
/// square of the number of matrix expressions in a file (docs/decisions/72_expressions_cost_their_square.md). What
/// examines, prepares or reports, and is not part of a step, therefore takes these.
///
///     Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 2);
///     const Eigen::VectorXd sigma = singular_values(a);                // (1, 1)
///     const Eigen::MatrixXd normal = orthogonal_factor(a).rightCols(1);  // the third axis
///
/// Requires finite entries; results of others are not numbers.

#include <Eigen/Core>

namespace lagroid {

/// Decreasing.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// A = U diag(values) V^T with square U and V.
struct SingularVectors {
  Eigen::VectorXd values;
  Eigen::MatrixXd u;
  Eigen::MatrixXd v;
};
SingularVectors singular_vectors(const Eigen::MatrixXd& a);

/// The same without U; the first `rank` values are above `threshold` times the largest.
struct RightSingularVectors {
  Eigen::VectorXd values;
  Eigen::MatrixXd v;
  Eigen::Index rank;
};
RightSingularVectors right_singular_vectors(const Eigen::MatrixXd& a, double threshold);

/// The X of least norm among those with the least |A X - B|.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The square Q of A = Q R, without pivoting: where the columns of A are independent, the first columns of Q span
/// theirs and the others what is orthogonal to them.
Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd& a);

/// An orthonormal basis of the span of the columns, as many as the rank.
Eigen::MatrixXd orthonormal_span(const Eigen::MatrixXd& a);

/// A = V diag(values) V^T of a symmetric A, of which the lower half is read; values increase.
struct SymmetricEigenvectors {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigenvectors symmetric_eigenvectors(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

/// A^{-1} B, A^{-1} and det A, with partial pivoting; the first two of a regular A.
Eigen::MatrixXd solve_regular(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& a);
double determinant_of(const Eigen::MatrixXd& a);

}  // namespace lagroid
