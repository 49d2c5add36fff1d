#include <lagroid/solvers/optimisation/methods/accelerated.hpp>

#include <lagroid/solvers/optimisation/lipschitz.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::optimisation {

void Accelerated::begin(Problem& problem, const EvaluatedPoint& state) {
  const Manifold& manifold = problem.manifold();
  if (options_.constraint == Constraint::multipliers && !manifold.offers(ManifoldRetraction::orthographic))
    throw std::invalid_argument(
        fmt::format("the {} has no steps with multipliers; take the constraint geodesics", manifold.name()));
  if (options_.constraint == Constraint::geodesics) chosen_retraction(manifold, ManifoldRetraction::exponential);
  for (Vector* v : {&displacement_, &v_, &moved_, &before_}) v->setZero(state.x.size());
  to_ = state.x;
  ahead_ = state;
  shortened_ = restarts_ = 0;
  start(problem, state);
}

/// From x along v_ to to_, by moved_, there. The multipliers take the normal part of v_ as well.
bool Accelerated::step(const Manifold& manifold, const Point& x) {
  if (options_.constraint == Constraint::multipliers) return manifold.orthographic(x, v_, to_, moved_);
  if (options_.constraint == Constraint::geodesics) {
    if (!manifold.retract(ManifoldRetraction::exponential, x, v_, to_)) return false;
    moved_ = v_;
    if (!manifold.parallel_transport(x, to_, moved_)) {
      moved_ = v_;
      manifold.transport(x, to_, moved_);
    }
    return true;
  }
  manifold.project(x, v_);
  to_ = x + v_;
  if (!manifold.nearest(to_)) return false;
  moved_ = to_ - x;
  return true;
}

StepOutcome Accelerated::advance(Problem& problem, EvaluatedPoint& state) {
  const Manifold& manifold = problem.manifold();
  const Shares shares = next();
  v_ = shares.momentum * displacement_;
  const EvaluatedPoint* at = &state;
  if (options_.look_ahead) {
    if (!step(manifold, state.x)) return StepOutcome::none;
    ahead_.x = to_;
    problem.evaluate(ahead_);
    if (options_.constraint == Constraint::geodesics) manifold.transport(ahead_.x, state.x, ahead_.gradient);
    at = &ahead_;
  }
  v_ -= shares.gradient * at->gradient;
  bool uphill = false;
  if (options_.restart) {
    before_ = at->gradient;
    manifold.project(state.x, before_);
    uphill = manifold.inner(state.x, before_, v_) > 0;
  }
  bool found = step(manifold, state.x);
  constexpr int most = 40;
  double longest = 0.5;
  for (int k = 0; !found && options_.rescale && k < most; ++k, longest /= 2) {
    if (k == 0) {
      ++shortened_;
      manifold.project(state.x, v_);
    }
    const double length = manifold.reach(v_);
    if (!(length > 0) || !std::isfinite(length)) return StepOutcome::none;
    v_ *= longest / length;
    found = step(manifold, state.x);
  }
  if (!found) return StepOutcome::none;
  std::swap(displacement_, moved_);
  const bool learns = learning();
  if (learns) before_ = state.gradient;
  std::swap(state.x, to_);
  problem.evaluate(state);
  if (learns) {
    manifold.transport(to_, state.x, before_);
    before_ -= state.gradient;
    learn(manifold.norm(state.x, before_), manifold.norm(state.x, displacement_));
  }
  if (uphill) {
    ++restarts_;
    forget();
    displacement_.setZero();
  }
  return StepOutcome::taken;
}

HamiltonianDescent::HamiltonianDescent(HamiltonianOptions hamiltonian, AcceleratedOptions options)
    : Accelerated(std::move(options)), hamiltonian_(hamiltonian) {
  check(hamiltonian_.bregman);
  if (!(hamiltonian_.diameter >= 0)) throw std::invalid_argument("the diameter of a domain is positive");
  if (!(hamiltonian_.h > 0) || !(hamiltonian_.start_time > 0) || !(hamiltonian_.cap > 0))
    throw std::invalid_argument("step, start time and cap are positive");
}

void HamiltonianDescent::start(Problem& problem, const EvaluatedPoint& state) {
  bregman_ = hamiltonian_.bregman;
  if (!bregman_.lambda) bregman_.lambda = zeta(problem.manifold(), hamiltonian_.diameter);
  largest_ = std::isfinite(hamiltonian_.cap) ? hamiltonian_.cap / lipschitz_bound(problem, state) : hamiltonian_.cap;
  time_ = hamiltonian_.start_time;
  last_alpha_ = 0;
}

Accelerated::Shares HamiltonianDescent::next() {
  const auto [alpha, beta, next_time] = coefficients(bregman_, time_, hamiltonian_.h);
  time_ = next_time;
  const double momentum = last_alpha_ > 0 ? alpha / last_alpha_ : 0;
  last_alpha_ = alpha;
  return {momentum, std::min(alpha * beta, largest_)};
}

void HamiltonianDescent::forget() {
  time_ = hamiltonian_.start_time;
  last_alpha_ = 0;
}

RobustDescent::RobustDescent(RobustOptions robust, AcceleratedOptions options)
    : Accelerated(std::move(options)), robust_(robust) {
  if (looks_ahead() && !(robust_.c > 0 && robust_.c < 4.0 / 3))
    throw std::invalid_argument("c of s = c / L is between 0 and 4 / 3 with look_ahead, best 1");
  if (!(robust_.c > 0 && robust_.c < 4)) throw std::invalid_argument("c of s = c / L is between 0 and 4, best 2");
  if (!(robust_.power > 0) || !(robust_.lipschitz >= 0)) throw std::invalid_argument("power and L are positive");
}

void RobustDescent::start(Problem& problem, const EvaluatedPoint& state) {
  steps_ = 0;
  known_ = robust_.lipschitz > 0 || problem.objective().lipschitz().has_value();
  lipschitz_ = robust_.lipschitz > 0 ? robust_.lipschitz : lipschitz_bound(problem, state);
}

Accelerated::Shares RobustDescent::next() {
  const double j = double(steps_++);
  return {std::pow(j / (j + 1), robust_.power + 1), robust_.c / lipschitz_};
}

void RobustDescent::learn(double change, double moved) {
  // Below this the difference of gradients is one of rounding errors.
  constexpr double telling = 1e-6;
  if (moved > telling) lipschitz_ = std::max(lipschitz_, change / moved);
}

}  // namespace lagroid::optimisation
