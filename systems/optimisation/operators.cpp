#include <lagroid/systems/optimisation/operators.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lagroid::optimisation {

std::pair<double, double> spectrum(const SymmetricOperator& a, double digits) {
  const Eigen::Index n = a.size;
  const Eigen::Index most = std::min<Eigen::Index>(n, 60);
  Eigen::MatrixXd basis(n, most);
  std::vector<double> diagonal;
  std::vector<double> off;
  Eigen::VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i)
    v(i) = std::sin(1.3 * double(i + 1)) + 0.5 * std::cos(0.37 * double(i) * double(i));
  v.normalize();
  Eigen::VectorXd w(n);
  std::pair<double, double> out{0, 0};
  for (Eigen::Index k = 0; k < most; ++k) {
    basis.col(k) = v;
    a.apply(v, w);
    diagonal.push_back(v.dot(w));
    // Twice is enough (Kahan).
    for (int again = 0; again < 2; ++again) w -= basis.leftCols(k + 1) * (basis.leftCols(k + 1).transpose() * w);
    const double rest = w.norm();
    const Eigen::Index m = k + 1;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
    // Eigen drops what is small beside one.
    const Eigen::Map<const Eigen::VectorXd> d(diagonal.data(), m);
    const Eigen::Map<const Eigen::VectorXd> e(off.data(), m - 1);
    const double size = std::max({1e-300, d.cwiseAbs().maxCoeff(), e.norm()});
    eigen.computeFromTridiagonal(d / size, e / size);
    const double low = size * eigen.eigenvalues()(0);
    const double high = size * eigen.eigenvalues()(m - 1);
    // An eigenvalue lies within the residual of each.
    const double low_error = rest * std::abs(eigen.eigenvectors()(m - 1, 0));
    const double high_error = rest * std::abs(eigen.eigenvectors()(m - 1, m - 1));
    out = {low - low_error, high + high_error};
    const double width = high - low;
    if (!std::isfinite(rest) || rest <= 1e-14 * std::max(std::abs(low), std::abs(high)) ||
        std::max(low_error, high_error) <= digits * width)
      break;
    off.push_back(rest);
    v = w / rest;
  }
  return out;
}

}  // namespace lagroid::optimisation
