#include <lagroid/solvers/sensitivity/sensitivities.hpp>

#include <fmt/format.h>

#include <limits>

namespace lagroid {

Sensitivities sensitivities_of(const Propagated& end, int states, std::vector<std::string> parameters) {
  Sensitivities out;
  out.status = end.status;
  out.message = end.message;
  out.parameters = std::move(parameters);
  out.growth = end.growth;
  out.digits_left = end.digits_left();
  if (!end.converged()) return out;
  out.by_start = end.end.topLeftCorner(states, states);
  out.by_parameters = end.end.topRightCorner(states, end.end.cols() - states);
  return out;
}

RunGradient gradient_of_run(const Propagated& start, int states, std::vector<std::string> parameters) {
  RunGradient out;
  out.status = start.status;
  out.message = start.message;
  out.parameters = std::move(parameters);
  out.growth = start.growth;
  out.digits_left = start.digits_left();
  out.steps_solved = start.steps_solved;
  out.states_kept = start.states_kept;
  if (!start.converged()) return out;
  out.values = start.values;
  out.by_start = start.derivatives.leftCols(states);
  out.by_parameters = start.derivatives.rightCols(start.derivatives.cols() - states);
  return out;
}

namespace detail {

void require_derivative(const std::string& name, const Eigen::VectorXd& derivative, const Eigen::VectorXd& coarse,
                        const Eigen::VectorXd& fine, double rounding) {
  const double uncertain = 10 * (coarse - fine).norm() + 100 * std::numeric_limits<double>::epsilon() * rounding;
  const double size = std::max(derivative.norm(), fine.norm());
  if ((derivative - fine).norm() <= 1e-3 * size + uncertain || !std::isfinite(uncertain)) return;
  throw WithoutDerivative(
      fmt::format("parameter {} carries no derivative: the system reads it as a plain number; its formulas must read "
                  "it by varied<S>(...) (core/scalars/varied.hpp)",
                  name));
}

}  // namespace detail

}  // namespace lagroid
