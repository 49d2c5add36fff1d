#include <lagroid/core/matrices/matrix_functions.hpp>

#include <Eigen/Eigenvalues>

namespace lagroid {

Eigen::VectorXcd matrix_eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(a, /*computeEigenvectors=*/false).eigenvalues();
}

}  // namespace lagroid
