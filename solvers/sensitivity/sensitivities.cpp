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

}  // namespace lagroid
