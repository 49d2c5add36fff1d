#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/hamiltonian/lagrangian.hpp>

#include <Eigen/SVD>

#include <limits>

namespace lagroid {

using Balance = Scaling<Eigen::Dynamic, Eigen::Dynamic>;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

double lagrangian_defect(const Eigen::MatrixXd& canonical) {
  if (!canonical.allFinite()) return infinity;
  Eigen::MatrixXd t = canonical;
  t.colwise().normalize();
  const Eigen::Index half = t.rows() / 2;
  const Eigen::MatrixXd form = t.topRows(half).transpose() * t.bottomRows(half);
  return (form - form.transpose()).cwiseAbs().maxCoeff();
}

LegendreRanks legendre_ranks(const SubmanifoldTangent& tangent) {
  const auto rank = [&](const Eigen::MatrixXd& a) {
    if (!a.allFinite()) return -1L;
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(Balance::equilibrate(a).apply(a));
    svd.setThreshold(singular_threshold);
    return long(svd.rank());
  };
  return {rank(tangent.minus), rank(tangent.plus)};
}

double poisson_defect(const SubmanifoldTangent& tangent) {
  if (!tangent.minus.allFinite() || !tangent.plus.allFinite() || !tangent.poisson_minus.allFinite() ||
      !tangent.poisson_plus.allFinite())
    return infinity;
  const Eigen::Index size = tangent.minus.rows();
  Eigen::MatrixXd image(2 * size, tangent.minus.cols());
  image << tangent.minus, tangent.plus;
  const auto balance = Balance::equilibrate(image);
  const Eigen::VectorXd scale = balance.row;
  Eigen::MatrixXd poisson = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  poisson.topLeftCorner(size, size) = -tangent.poisson_minus;
  poisson.bottomRightCorner(size, size) = tangent.poisson_plus;
  poisson = (scale.asDiagonal() * poisson * scale.asDiagonal()).eval();
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(balance.apply(image), Eigen::ComputeFullU);
  svd.setThreshold(singular_threshold);
  const Eigen::MatrixXd annihilators = svd.matrixU().rightCols(2 * size - svd.rank());
  const double largest = poisson.cwiseAbs().maxCoeff();
  if (largest == 0) return 0;
  return (annihilators.transpose() * poisson * annihilators).cwiseAbs().maxCoeff() / largest;
}

}  // namespace lagroid
