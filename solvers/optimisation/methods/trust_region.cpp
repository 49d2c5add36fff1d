#include <lagroid/solvers/optimisation/methods/trust_region.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid::optimisation {

void TrustRegion::begin(Problem& problem, const EvaluatedPoint& state) {
  largest_ = options_.largest_radius > 0 ? options_.largest_radius : std::sqrt(double(problem.manifold().dimension()));
  radius_ = options_.first_radius > 0 ? std::min(options_.first_radius, largest_) : largest_ / 8;
  retraction_ = chosen_retraction(problem.manifold(), options_.retraction);
  first_gradient_ = problem.manifold().norm(state.x, state.gradient);
  for (Vector* v : {&step_, &next_step_, &curved_step_, &residual_, &direction_, &curved_}) v->setZero(state.x.size());
  to_ = state.x;
}

/// step_, and the Hessian along it.
void TrustRegion::solve_model(Problem& problem, const EvaluatedPoint& state) {
  const Manifold& manifold = problem.manifold();
  const auto inner = [&](const Vector& u, const Vector& v) { return manifold.inner(state.x, u, v); };
  const long most = options_.inner_iterations > 0 ? options_.inner_iterations : manifold.dimension();
  step_.setZero();
  curved_step_.setZero();
  residual_ = state.gradient;
  direction_ = -residual_;
  double square = inner(residual_, residual_);
  // Quadratic convergence, but no digits that rounding does not have.
  const double length = std::sqrt(square);
  const double enough = length * std::clamp(length / first_gradient_, 1e-10, 0.1);
  for (long k = 0; k < most; ++k) {
    problem.hessian(state, direction_, curved_);
    const double curvature = inner(direction_, curved_);
    const double along = square / curvature;
    next_step_ = step_ + along * direction_;
    if (!(curvature > 0) || !(manifold.norm(state.x, next_step_) < radius_)) {
      // To the border: |step + t direction| = radius.
      const double a = inner(direction_, direction_);
      const double b = inner(step_, direction_);
      const double c = radius_ * radius_ - inner(step_, step_);
      const double t = c / (b + std::sqrt(b * b + a * c));
      step_ += t * direction_;
      curved_step_ += t * curved_;
      return;
    }
    std::swap(step_, next_step_);
    curved_step_ += along * curved_;
    residual_ += along * curved_;
    manifold.project(state.x, residual_);
    const double next = inner(residual_, residual_);
    if (std::sqrt(next) <= enough) return;
    direction_ = next / square * direction_ - residual_;
    square = next;
  }
}

StepOutcome TrustRegion::advance(Problem& problem, EvaluatedPoint& state) {
  constexpr int most = 60;
  const Manifold& manifold = problem.manifold();
  const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * std::abs(state.value);
  for (int k = 0; k < most; ++k) {
    solve_model(problem, state);
    const double promised =
        -manifold.inner(state.x, state.gradient, step_) - 0.5 * manifold.inner(state.x, step_, curved_step_);
    double share = -1;
    if (promised > 0 && manifold.retract(retraction_, state.x, step_, to_)) {
      // Near the minimum both falls are rounding, and their ratio is made one.
      const double fall = state.value - problem.value(to_);
      if (std::isfinite(fall)) share = (fall + rounding) / (promised + rounding);
    }
    const double length = manifold.norm(state.x, step_);
    if (share < 0.25)
      radius_ = 0.25 * length;
    else if (share > 0.75 && length > 0.99 * radius_)
      radius_ = std::min(2 * radius_, largest_);
    if (share > 0.1) {
      state.x = to_;
      problem.evaluate(state);
      return StepOutcome::taken;
    }
    if (!(radius_ > 0)) return StepOutcome::none;
  }
  return StepOutcome::none;
}

}  // namespace lagroid::optimisation
