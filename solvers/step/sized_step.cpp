#include <lagroid/solvers/step/sized_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::detail {

bool solve_equilibrated(Eigen::PartialPivLU<Eigen::MatrixXd>& factor, Eigen::MatrixXd& matrix, Eigen::VectorXd& right,
                        Eigen::VectorXd& x) {
  constexpr double smallest = 1e-13;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double size = matrix.row(i).cwiseAbs().maxCoeff();
    if (!(size > 0)) return false;
    matrix.row(i) /= size;
    right(i) /= size;
  }
  factor.compute(matrix);
  const auto pivots = factor.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > smallest * pivots.maxCoeff())) return false;
  x.noalias() = factor.solve(right);
  return x.allFinite();
}

double roundoff_ratio(const Eigen::VectorXd& residual, const Eigen::VectorXd& terms) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  double worst = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double size = std::abs(residual(i));
    if (!std::isfinite(size) || !std::isfinite(terms(i))) return std::numeric_limits<double>::infinity();
    if (size > 0) worst = std::max(worst, size / (rounding * terms(i)));
  }
  return worst;
}

}  // namespace lagroid::detail
