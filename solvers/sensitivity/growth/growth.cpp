#include <lagroid/solvers/sensitivity/growth/growth.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

void OwnUnits::see(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return;
  if (seen_++ == 0) sum_ = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
  sum_ += (matrix - Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols())).cwiseAbs();
}

Eigen::VectorXd OwnUnits::of(Eigen::Index components) const {
  Eigen::VectorXd units = Eigen::VectorXd::Ones(components);
  if (seen_ == 0) return units;
  // What acts one way alone acts back by so little that all steps together count once.
  Eigen::MatrixXd coupling = sum_ / double(seen_);
  const double back = 1 / (double(asked_) * double(asked_));
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> reaches = sum_.array() > 0;
  for (Eigen::Index k = 0; k < components; ++k)
    for (Eigen::Index i = 0; i < components; ++i)
      for (Eigen::Index j = 0; j < components; ++j) reaches(i, j) = reaches(i, j) || (reaches(i, k) && reaches(k, j));
  for (Eigen::Index i = 0; i < components; ++i)
    for (Eigen::Index j = 0; j < components; ++j)
      if (sum_(j, i) > 0 && !reaches(i, j)) coupling(i, j) += back * double(seen_) / sum_(j, i);
  coupling.diagonal().setZero();
  constexpr int most_sweeps = 200;
  constexpr double settled = 1e-3;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index i = 0; i < components; ++i) {
      const double row = coupling.row(i).dot(units) / units(i);
      const double column = coupling.col(i).dot(units.cwiseInverse()) * units(i);
      const double factor = std::sqrt(row / column);
      if (!(factor > 0 && std::isfinite(factor))) continue;
      units(i) *= factor;
      change = std::max(change, std::abs(std::log(factor)));
    }
    if (change < settled) break;
  }
  return units;
}

double largest_ratio(const Eigen::MatrixXd& first, const Eigen::MatrixXd& peak, const Eigen::VectorXd& scale) {
  double largest = 1;
  for (Eigen::Index j = 0; j < first.cols(); ++j) {
    const double before = first.col(j).cwiseProduct(scale).norm();
    if (before > 0) largest = std::max(largest, peak.col(j).cwiseProduct(scale).norm() / before);
  }
  return largest;
}

Growth::Growth(const Eigen::MatrixXd& directions)
    : first_(directions.cwiseAbs()),
      peak_(first_),
      added_(first_.colwise().maxCoeff().array() == 0),
      last_(first_.colwise().maxCoeff()) {}

void Growth::after_a_step(const Eigen::MatrixXd& directions) {
  ++steps_;
  for (Eigen::Index j = 0; j < directions.cols(); ++j) {
    if (!directions.col(j).allFinite()) {
      peak_.col(j).setConstant(std::numeric_limits<double>::infinity());
      continue;
    }
    const double steps = added_(j) ? double(steps_) : 1;
    const Eigen::VectorXd now = directions.col(j).cwiseAbs() / steps;
    // No step makes ten thousand million of one: what was there before was rounding.
    constexpr double rounding = 1e-10;
    const bool is_first = added_(j) && !(last_(j) > rounding * now.maxCoeff());
    if (is_first || first_.col(j).maxCoeff() == 0) first_.col(j) = now;
    peak_.col(j) = peak_.col(j).cwiseMax(now);
    last_(j) = now.maxCoeff();
  }
}

double Growth::largest() const { return largest_ratio(first_, peak_, units_.of(first_.rows()).cwiseInverse()); }

}  // namespace lagroid
