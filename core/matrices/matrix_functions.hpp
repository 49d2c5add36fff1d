#pragma once
/// e^A, the principal logarithm, the eigenvalues of square matrices whose size is known at run time, and a Lyapunov
/// equation with them.
///
/// Eigen's templates for them are the most expensive there are to compile: they are compiled here alone.
///
///     const Eigen::MatrixXd rotation = matrix_exponential(generator);
///     const Eigen::MatrixXd again = matrix_logarithm(rotation);
///
/// The logarithm requires that no eigenvalue lies on the negative real axis or at 0.

#include <Eigen/Core>

namespace lagroid {

/// e^A.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a);
/// The principal logarithm of A, which has no eigenvalue on the negative real axis or at 0.
Eigen::MatrixXd matrix_logarithm(const Eigen::MatrixXd& a);
Eigen::VectorXcd matrix_eigenvalues(const Eigen::MatrixXd& a);
/// D with D K + K^T D = F, F symmetric. False where K and -K^T share an eigenvalue.
bool solve_lyapunov(const Eigen::MatrixXd& k, const Eigen::MatrixXd& f, Eigen::MatrixXd& d);

}  // namespace lagroid
