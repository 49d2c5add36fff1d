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
  for (const double gamma : composition_.coefficients) {
    const StepReport report = step_->take(trial_, t, gamma * h);
    all.iterations += report.iterations;
    all.residual = std::max(all.residual, report.residual);
    all.roundoff_ratio = std::max(all.roundoff_ratio, report.roundoff_ratio);
    if (!report.converged()) {
      all.status = report.status;
      return all;
    }
    t += gamma * h;
  }
  std::swap(z, trial_);
  return all;
}

bool ComposedSizedStep::linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) {
  for (const double gamma : composition_.coefficients) {
    if (!step_->linearise(z, t, gamma * h, stages)) return false;
    t += gamma * h;
  }
  return true;
}

namespace detail {

bool solve_in_units(Eigen::PartialPivLU<Eigen::MatrixXd>& factor, Eigen::MatrixXd& matrix, Eigen::VectorXd& right,
                    Eigen::VectorXd& x, Eigen::VectorXd& units) {
  constexpr double smallest = 1e-13;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix.col(j) *= units(j);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double largest = matrix.row(i).cwiseAbs().maxCoeff();
    if (!(largest > 0)) return false;
    matrix.row(i) /= largest;
    right(i) /= largest;
  }
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double largest = matrix.col(j).cwiseAbs().maxCoeff();
    if (!(largest > 0)) return false;
    matrix.col(j) /= largest;
    units(j) /= largest;
  }
  factor.compute(matrix);
  const auto pivots = factor.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > smallest * pivots.maxCoeff())) return false;
  x.noalias() = factor.solve(right);
  x.array() *= units.array();
  return x.allFinite();
}

double unit_of_multipliers(const Eigen::MatrixXd& matrix, Eigen::Index first) {
  const Eigen::Index count = matrix.cols() - first;
  const double block = matrix.topLeftCorner(first, first).cwiseAbs().maxCoeff();
  const double beside = matrix.topRightCorner(first, count).cwiseAbs().maxCoeff();
  return block > 0 && beside > 0 ? block / beside : 1;
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

}  // namespace detail

}  // namespace lagroid
