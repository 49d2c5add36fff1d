#include <lagroid/core/matrices/matrix_functions.hpp>

#include <Eigen/Eigenvalues>

#include <complex>

namespace lagroid {

bool solve_lyapunov(const Eigen::MatrixXd& k, const Eigen::MatrixXd& f, Eigen::MatrixXd& d) {
  // In the Schur form K = U R U^H, column by column.
  const Eigen::Index m = k.rows();
  const Eigen::ComplexSchur<Eigen::MatrixXd> schur(k);
  if (schur.info() != Eigen::Success) return false;
  const Eigen::MatrixXcd& u = schur.matrixU();
  const Eigen::MatrixXcd& r = schur.matrixT();
  Eigen::MatrixXcd y = u.transpose() * f * u;
  const double least_pivot = 1e-14 * (1 + r.norm());
  for (Eigen::Index j = 0; j < m; ++j)
    for (Eigen::Index i = 0; i < m; ++i) {
      std::complex<double> sum = y(i, j);
      for (Eigen::Index l = 0; l < i; ++l) sum -= r(l, i) * y(l, j);
      for (Eigen::Index l = 0; l < j; ++l) sum -= y(i, l) * r(l, j);
      const std::complex<double> pivot = r(i, i) + r(j, j);
      if (std::abs(pivot) < least_pivot) return false;
      y(i, j) = sum / pivot;
    }
  d = (u.conjugate() * y * u.adjoint()).real();
  return true;
}

}  // namespace lagroid
