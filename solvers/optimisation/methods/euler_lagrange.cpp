#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>

#include <lagroid/solvers/optimisation/lipschitz.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lagroid::optimisation {

EulerLagrange::EulerLagrange(EulerLagrangeOptions options) : options_(options) {
  if (!(options.p > 0) || !(options.c > 0) || !(options.h > 0) || !(options.cap > 0) ||
      !(options.lambda.value_or(1) >= 1))
    throw std::invalid_argument("p, C, h and the cap of Algorithm 2 are positive, lambda at least 1");
  if (!(options.diameter >= 0)) throw std::invalid_argument("the diameter of a domain is positive");
  if (options.version != 1 && options.version != 2) throw std::invalid_argument("Algorithm 2 has the versions 1 and 2");
}

std::string EulerLagrange::name() const { return options_.version == 1 ? "Euler-Lagrange I" : "Euler-Lagrange II"; }

void EulerLagrange::begin(Problem& problem, const EvaluatedPoint& state) {
  retraction_ = chosen_retraction(problem.manifold(), options_.retraction);
  lambda_ = options_.lambda ? *options_.lambda : zeta(problem.manifold(), options_.diameter);
  k_ = lambda_ > 1 ? std::ceil(lambda_ * options_.p) : 0;
  largest_ = options_.cap;
  if (std::isfinite(largest_)) largest_ /= options_.h * options_.h * lipschitz_bound(problem, state);
  velocity_.setZero(state.x.size());
  v_ = velocity_;
  to_ = state.x;
  ahead_ = state;
}

StepOutcome EulerLagrange::advance(Problem& problem, EvaluatedPoint& state) {
  const Manifold& manifold = problem.manifold();
  const double k = ++k_;
  const double h = options_.h;
  const double b = 1 - (lambda_ * options_.p + 1) / k;
  const double c = std::min(options_.c * options_.p * options_.p * std::pow(k * h, options_.p - 2), largest_);
  velocity_ *= b;
  if (options_.version == 2) {
    v_ = h * velocity_;
    if (!manifold.retract(retraction_, state.x, v_, ahead_.x)) return StepOutcome::none;
    problem.evaluate(ahead_);
    v_ = ahead_.gradient;
    manifold.transport(ahead_.x, state.x, v_);
    velocity_ -= h * c * v_;
  } else {
    velocity_ -= h * c * state.gradient;
  }
  v_ = h * velocity_;
  if (!manifold.retract(retraction_, state.x, v_, to_)) return StepOutcome::none;
  manifold.transport(state.x, to_, velocity_);
  state.x = to_;
  problem.evaluate(state);
  return StepOutcome::taken;
}

}  // namespace lagroid::optimisation
