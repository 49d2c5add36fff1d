#include <lagroid/core/matrices/matrix_functions.hpp>

#include <Eigen/Eigenvalues>
#include <unsupported/Eigen/MatrixFunctions>

namespace lagroid {

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a) { return a.exp(); }
Eigen::MatrixXd matrix_logarithm(const Eigen::MatrixXd& a) { return a.log(); }
Eigen::VectorXcd matrix_eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(a, /*computeEigenvectors=*/false).eigenvalues();
}

}  // namespace lagroid
