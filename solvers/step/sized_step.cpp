#include <lagroid/solvers/step/sized_step.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

StepReport ComposedSizedStep::take(SizedState& z, double t, double h) {
  trial_ = z;
  StepReport all;
  all.status = SolveStatus::converged;
  for (std::size_t i = 0; i < gammas_.size(); ++i) {
    const StepReport report = method_of(i).take(trial_, t, gammas_[i] * h);
    all.iterations += report.iterations;
    all.residual = std::max(all.residual, report.residual);
    all.roundoff_ratio = std::max(all.roundoff_ratio, report.roundoff_ratio);
    if (!report.converged()) {
      all.status = report.status;
      return all;
    }
    t += gammas_[i] * h;
  }
  std::swap(z, trial_);
  return all;
}

bool ComposedSizedStep::linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) {
  for (std::size_t i = 0; i < gammas_.size(); ++i) {
    if (!method_of(i).linearise(z, t, gammas_[i] * h, stages)) return false;
    t += gammas_[i] * h;
  }
  return true;
}

namespace detail {

void SizedNewton::resize(Eigen::Index count) {
  if (unknown.size() == count && matrix.rows() == count) return;
  for (Eigen::VectorXd* each : {&unknown, &residual, &terms, &units, &update_}) each->setZero(count);
  matrix.setZero(count, count);
  factor_ = Eigen::PartialPivLU<Eigen::MatrixXd>(count);
}

bool SizedNewton::find_update() {
  constexpr double smallest = 1e-13;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix.col(j) *= units(j);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double largest = matrix.row(i).cwiseAbs().maxCoeff();
    if (!(largest > 0)) return false;
    matrix.row(i) /= largest;
    residual(i) /= largest;
  }
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double largest = matrix.col(j).cwiseAbs().maxCoeff();
    if (!(largest > 0)) return false;
    matrix.col(j) /= largest;
    units(j) /= largest;
  }
  factor_.compute(matrix);
  const auto pivots = factor_.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > smallest * pivots.maxCoeff())) return false;
  update_.noalias() = factor_.solve(residual);
  update_.array() *= units.array();
  return update_.allFinite();
}

double SizedNewton::unit_of_multipliers(Eigen::Index first) const {
  const Eigen::Index count = matrix.cols() - first;
  const double block = matrix.topLeftCorner(first, first).cwiseAbs().maxCoeff();
  const double beside = matrix.topRightCorner(first, count).cwiseAbs().maxCoeff();
  return block > 0 && beside > 0 ? block / beside : 1;
}

double SizedNewton::roundoff_ratio() const {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  double worst = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double size = std::abs(residual(i));
    if (!std::isfinite(size) || !std::isfinite(terms(i))) return std::numeric_limits<double>::infinity();
    if (size > 0) worst = std::max(worst, size / (rounding * terms(i)));
  }
  return worst;
}

}  // namespace detail

}  // namespace lagroid
