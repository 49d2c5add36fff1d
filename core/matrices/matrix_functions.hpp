#pragma once
/// Functions of square matrices whose size is known when it runs. Eigen's templates for them are the dearest there are
/// to compile: they are compiled here alone.

#include <Eigen/Core>

namespace lagroid {

/// e^A.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a);
/// The principal logarithm of A, which has no eigenvalue on the negative real axis or at 0.
Eigen::MatrixXd matrix_logarithm(const Eigen::MatrixXd& a);
Eigen::VectorXcd matrix_eigenvalues(const Eigen::MatrixXd& a);

}  // namespace lagroid
