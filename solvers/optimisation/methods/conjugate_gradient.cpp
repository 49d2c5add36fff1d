#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>

#include <lagroid/solvers/optimisation/line_search.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::optimisation {

void ConjugateGradient::begin(Problem& problem, const EvaluatedPoint& state) {
  retraction_ = chosen_retraction(problem.manifold(), asked_);
  direction_ = -state.gradient;
  before_ = v_ = state.gradient;
  to_ = state;
  const double length = problem.manifold().norm(state.x, state.gradient);
  first_ = length > 0 ? 1 / length : 1;
}

StepOutcome ConjugateGradient::advance(Problem& problem, EvaluatedPoint& state) {
  constexpr double flat = 0.1;
  const Manifold& manifold = problem.manifold();
  const auto square = [&](const Vector& v) { return manifold.inner(state.x, v, v); };
  double slope = manifold.inner(state.x, state.gradient, direction_);
  if (!(slope < 0)) {
    direction_ = -state.gradient;
    slope = -square(state.gradient);
  }
  double t = secant_search(problem, retraction_, state, direction_, slope, first_, flat, to_, v_);
  if (!(t > 0)) {
    direction_ = -state.gradient;
    slope = -square(state.gradient);
    t = secant_search(problem, retraction_, state, direction_, slope, first_, flat, to_, v_);
    if (!(t > 0)) return StepOutcome::none;
  }
  before_ = state.gradient;
  std::swap(state, to_);

  manifold.transport(to_.x, state.x, before_);
  manifold.transport(to_.x, state.x, direction_);
  v_ = state.gradient - before_;
  const double curved = manifold.inner(state.x, direction_, v_);  // t times the second derivative along the line
  const double b = curved > 0 ? std::max(0.0, manifold.inner(state.x, state.gradient, v_) / curved) : 0;
  const double square_before = square(direction_);
  direction_ = b * direction_ - state.gradient;
  // The minimum along the next line if f curves there, per length, as it did along this one.
  const double scale = square_before / std::max(square(direction_), 1e-300);
  first_ =
      curved > 0 ? -manifold.inner(state.x, state.gradient, direction_) * scale * t / curved : 2 * t * std::sqrt(scale);
  if (!(first_ > 0) || !std::isfinite(first_)) first_ = t;
  return StepOutcome::taken;
}

}  // namespace lagroid::optimisation
