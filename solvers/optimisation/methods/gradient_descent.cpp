#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>

#include <lagroid/solvers/optimisation/line_search.hpp>
#include <lagroid/solvers/optimisation/lipschitz.hpp>

#include <stdexcept>

namespace lagroid::optimisation {

GradientDescent::GradientDescent(GradientDescentOptions options) : options_(options) {
  if (!(options.step >= 0) || !(options.c >= 0) || (options.step > 0 && options.c > 0))
    throw std::invalid_argument("gradient descent takes a positive step, or c of c / L, or neither for a line search");
  if (!(options.decrease > 0 && options.decrease < 1)) throw std::invalid_argument("0 < decrease < 1");
}

std::string GradientDescent::name() const {
  return options_.step > 0 || options_.c > 0 ? "gradient descent" : "gradient descent, line search";
}

void GradientDescent::begin(Problem& problem, const EvaluatedPoint& state) {
  step_ = options_.c > 0 ? options_.c / lipschitz_bound(problem, state) : options_.step;
  retraction_ = chosen_retraction(problem.manifold(), options_.retraction);
  v_.setZero(state.x.size());
  to_ = state.x;
  const double length = problem.manifold().norm(state.x, state.gradient);
  last_ = length > 0 ? 1 / length : 1;
}

StepOutcome GradientDescent::advance(Problem& problem, EvaluatedPoint& state) {
  if (step_ > 0) {
    v_ = -step_ * state.gradient;
    if (!problem.manifold().retract(retraction_, state.x, v_, to_)) return StepOutcome::none;
  } else {
    const double slope = problem.manifold().inner(state.x, state.gradient, state.gradient);
    Vector& direction = state.gradient;
    direction = -direction;
    last_ = backtrack(problem, retraction_, state, direction, -slope, 2 * last_, options_.decrease, to_, v_);
    if (!(last_ > 0)) {
      direction = -direction;
      return StepOutcome::none;
    }
  }
  state.x = to_;
  problem.evaluate(state);
  return StepOutcome::taken;
}

}  // namespace lagroid::optimisation
