#include <lagroid/core/matrices/matrix_functions.hpp>

#include <unsupported/Eigen/MatrixFunctions>

namespace lagroid {

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& a) { return a.exp(); }
Eigen::MatrixXd matrix_logarithm(const Eigen::MatrixXd& a) { return a.log(); }

}  // namespace lagroid
