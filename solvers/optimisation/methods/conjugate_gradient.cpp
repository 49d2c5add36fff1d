#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>

#include <lagroid/solvers/optimisation/line_search.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::optimisation {

void ConjugateGradient::begin(Problem&, const EvaluatedPoint& state) {
  direction_ = -state.gradient;
  before_ = v_ = state.gradient;
  to_ = state;
  const double length = state.gradient.norm();
  first_ = length > 0 ? 1 / length : 1;
}

StepOutcome ConjugateGradient::advance(Problem& problem, EvaluatedPoint& state) {
  constexpr double flat = 0.1;
  double slope = state.gradient.dot(direction_);
  if (!(slope < 0)) {
    direction_ = -state.gradient;
    slope = -state.gradient.squaredNorm();
  }
  double t = secant_search(problem, retraction_, state, direction_, slope, first_, flat, to_, v_);
  if (!(t > 0)) {
    direction_ = -state.gradient;
    slope = -state.gradient.squaredNorm();
    t = secant_search(problem, retraction_, state, direction_, slope, first_, flat, to_, v_);
    if (!(t > 0)) return StepOutcome::none;
  }
  before_ = state.gradient;
  std::swap(state, to_);

  const Manifold& manifold = problem.manifold();
  manifold.transport(state.x, before_);
  manifold.transport(state.x, direction_);
  v_ = state.gradient - before_;
  const double curved = direction_.dot(v_);  // t times the second derivative along the line
  const double b = curved > 0 ? std::max(0.0, state.gradient.dot(v_) / curved) : 0;
  const double square_before = direction_.squaredNorm();
  direction_ = b * direction_ - state.gradient;
  // The minimum along the next line if f curves there, per length, as it did along this one.
  const double scale = square_before / std::max(direction_.squaredNorm(), 1e-300);
  first_ = curved > 0 ? -state.gradient.dot(direction_) * scale * t / curved : 2 * t * std::sqrt(scale);
  if (!(first_ > 0) || !std::isfinite(first_)) first_ = t;
  return StepOutcome::taken;
}

}  // namespace lagroid::optimisation
