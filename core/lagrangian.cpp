#include <lagroid/core/lagrangian.hpp>

#include <Eigen/SVD>

#include <cmath>

namespace lagroid {

namespace {

/// Scales rows and columns of `a` to largest entries near one (Ruiz); returns the rows' scales.
Eigen::VectorXd equilibrate(Eigen::MatrixXd& a) {
  Eigen::VectorXd row = Eigen::VectorXd::Ones(a.rows());
  const auto inverse_root = [](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; };
  for (int sweep = 0; sweep < 8; ++sweep) {
    const Eigen::VectorXd r = a.cwiseAbs().rowwise().maxCoeff().unaryExpr(inverse_root);
    const Eigen::VectorXd c = a.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(inverse_root);
    a = (r.asDiagonal() * a * c.asDiagonal()).eval();
    row = row.cwiseProduct(r);
  }
  return row;
}

}  // namespace

double lagrangian_defect(const Eigen::MatrixXd& canonical) {
  Eigen::MatrixXd t = canonical;
  t.colwise().normalize();
  const Eigen::Index half = t.rows() / 2;
  const Eigen::MatrixXd form = t.topRows(half).transpose() * t.bottomRows(half);
  return (form - form.transpose()).cwiseAbs().maxCoeff();
}

LegendreRanks legendre_ranks(const SubmanifoldTangent& tangent, double threshold) {
  const auto rank = [&](Eigen::MatrixXd a) {
    equilibrate(a);
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(a);
    svd.setThreshold(threshold);
    return long(svd.rank());
  };
  return {rank(tangent.minus), rank(tangent.plus)};
}

double poisson_defect(const SubmanifoldTangent& tangent) {
  const Eigen::Index size = tangent.minus.rows();
  Eigen::MatrixXd image(2 * size, tangent.minus.cols());
  image << tangent.minus, tangent.plus;
  const Eigen::VectorXd scale = equilibrate(image);
  Eigen::MatrixXd poisson = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  poisson.topLeftCorner(size, size) = -tangent.poisson_minus;
  poisson.bottomRightCorner(size, size) = tangent.poisson_plus;
  poisson = (scale.asDiagonal() * poisson * scale.asDiagonal()).eval();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(image, Eigen::ComputeFullU);
  const Eigen::MatrixXd annihilators = svd.matrixU().rightCols(2 * size - svd.rank());
  const double largest = poisson.cwiseAbs().maxCoeff();
  if (largest == 0) return 0;
  return (annihilators.transpose() * poisson * annihilators).cwiseAbs().maxCoeff() / largest;
}

}  // namespace lagroid
