#include <lagroid/solvers/optimisation/methods/trust_region.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::optimisation {

void TrustRegion::begin(Problem& problem, const EvaluatedPoint& state) {
  largest_ = options_.largest_radius > 0 ? options_.largest_radius : std::sqrt(double(problem.manifold().dimension()));
  radius_ = options_.first_radius > 0 ? std::min(options_.first_radius, largest_) : largest_ / 8;
  first_gradient_ = state.gradient.norm();
  for (Vector* v : {&step_, &curved_step_, &residual_, &direction_, &curved_}) v->setZero(state.x.size());
  to_ = state.x;
}

/// step_, and the Hessian along it.
void TrustRegion::solve_model(Problem& problem, const EvaluatedPoint& state) {
  const long most = options_.inner_iterations > 0 ? options_.inner_iterations : problem.manifold().dimension();
  step_.setZero();
  curved_step_.setZero();
  residual_ = state.gradient;
  direction_ = -residual_;
  double square = residual_.squaredNorm();
  // Quadratic convergence, but no digits that rounding does not have.
  const double length = std::sqrt(square);
  const double enough = length * std::clamp(length / first_gradient_, 1e-10, 0.1);
  for (long k = 0; k < most; ++k) {
    problem.hessian(state, direction_, curved_);
    const double curvature = direction_.dot(curved_);
    const double along = square / curvature;
    const double length_after = (step_ + along * direction_).norm();
    if (!(curvature > 0) || !(length_after < radius_)) {
      // To the border: |step + t direction| = radius.
      const double a = direction_.squaredNorm();
      const double b = step_.dot(direction_);
      const double c = radius_ * radius_ - step_.squaredNorm();
      const double t = c / (b + std::sqrt(b * b + a * c));
      step_ += t * direction_;
      curved_step_ += t * curved_;
      return;
    }
    step_ += along * direction_;
    curved_step_ += along * curved_;
    residual_ += along * curved_;
    problem.manifold().project(state.x, residual_);
    const double next = residual_.squaredNorm();
    if (std::sqrt(next) <= enough) return;
    direction_ = next / square * direction_ - residual_;
    square = next;
  }
}

StepOutcome TrustRegion::advance(Problem& problem, EvaluatedPoint& state) {
  constexpr int most = 60;
  const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * std::abs(state.value);
  for (int k = 0; k < most; ++k) {
    solve_model(problem, state);
    const double promised = -state.gradient.dot(step_) - 0.5 * step_.dot(curved_step_);
    double share = -1;
    if (promised > 0 && problem.manifold().retract(options_.retraction, state.x, step_, to_)) {
      // Near the minimum both falls are rounding, and their ratio is made one.
      const double fall = state.value - problem.value(to_);
      if (std::isfinite(fall)) share = (fall + rounding) / (promised + rounding);
    }
    const double length = step_.norm();
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
