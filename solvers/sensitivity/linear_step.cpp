#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>

#include <limits>

namespace lagroid {

LinearStep::LinearStep(int equations, int states, int parameters)
    : equations_by_unknowns(Eigen::MatrixXd::Zero(equations, equations)),
      equations_by_start(Eigen::MatrixXd::Zero(equations, states + parameters)),
      end_by_unknowns(Eigen::MatrixXd::Zero(states, equations)),
      end_by_start(Eigen::MatrixXd::Zero(states, states + parameters)) {}

bool LinearStep::factor() {
  if (!equations_by_unknowns.allFinite() || !equations_by_start.allFinite() || !end_by_unknowns.allFinite() ||
      !end_by_start.allFinite())
    return false;
  if (equations_by_unknowns.size() == 0) return true;
  const auto scaling = Scaling<Eigen::Dynamic>::equilibrate(equations_by_unknowns);
  row_scale_ = scaling.row;
  column_scale_ = scaling.column;
  factors_.compute(scaling.apply(equations_by_unknowns));
  return factors_.rcond() > std::numeric_limits<double>::epsilon();
}

Eigen::MatrixXd LinearStep::forward(const Eigen::MatrixXd& directions) const {
  const Eigen::Index states = end_by_start.rows();
  Eigen::MatrixXd out = directions;
  out.topRows(states) = end_by_start * directions;
  if (equations_by_unknowns.size() == 0) return out;
  const Eigen::MatrixXd right = row_scale_.asDiagonal() * (equations_by_start * directions);
  const Eigen::MatrixXd unknowns = column_scale_.asDiagonal() * factors_.solve(right);
  out.topRows(states) -= end_by_unknowns * unknowns;
  return out;
}

Eigen::MatrixXd LinearStep::backward(const Eigen::MatrixXd& gradients) const {
  const Eigen::Index states = end_by_start.rows();
  Eigen::MatrixXd out = gradients;
  out.topRows(states).setZero();
  out += end_by_start.transpose() * gradients.topRows(states);
  if (equations_by_unknowns.size() == 0) return out;
  const Eigen::MatrixXd right = column_scale_.asDiagonal() * (end_by_unknowns.transpose() * gradients.topRows(states));
  const Eigen::MatrixXd solved = factors_.transpose().solve(right);
  out -= equations_by_start.transpose() * (row_scale_.asDiagonal() * solved);
  return out;
}

}  // namespace lagroid
