#include <lagroid/solvers/optimisation/methods/accelerated.hpp>

#include <lagroid/solvers/optimisation/lipschitz.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::optimisation {

void Accelerated::begin(Problem& problem, const EvaluatedPoint& state) {
  for (Vector* v : {&displacement_, &v_, &moved_, &before_}) v->setZero(state.x.size());
  to_ = state.x;
  ahead_ = state;
  shortened_ = restarts_ = 0;
  start(problem, state);
}

/// From x along v_ to to_, by moved_. The multipliers take the normal part of v_ as well.
bool Accelerated::step(Problem& problem, const Point& x) {
  const Manifold& manifold = problem.manifold();
  if (options_.constraint == Constraint::multipliers) return manifold.orthographic(x, v_, to_, moved_);
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
    if (!step(problem, state.x)) return StepOutcome::none;
    ahead_.x = to_;
    problem.evaluate(ahead_);
    at = &ahead_;
  }
  v_ -= shares.gradient * at->gradient;
  bool uphill = false;
  if (options_.restart) {
    before_ = at->gradient;
    manifold.project(state.x, before_);
    uphill = before_.dot(v_) > 0;
  }
  bool found = step(problem, state.x);
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
    found = step(problem, state.x);
  }
  if (!found) return StepOutcome::none;
  std::swap(displacement_, moved_);
  const bool learns = learning();
  if (learns) before_ = state.gradient;
  std::swap(state.x, to_);
  problem.evaluate(state);
  if (learns) {
    manifold.transport(state.x, before_);
    before_ -= state.gradient;
    learn(before_.norm(), displacement_.norm());
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
  if (!(hamiltonian_.h > 0) || !(hamiltonian_.start_time > 0) || !(hamiltonian_.cap > 0))
    throw std::invalid_argument("step, start time and cap are positive");
}

void HamiltonianDescent::start(Problem& problem, const EvaluatedPoint& state) {
  largest_ = std::isfinite(hamiltonian_.cap) ? hamiltonian_.cap / lipschitz_bound(problem, state) : hamiltonian_.cap;
  time_ = hamiltonian_.start_time;
  last_alpha_ = 0;
}

Accelerated::Shares HamiltonianDescent::next() {
  const auto [alpha, beta, next_time] = coefficients(hamiltonian_.bregman, time_, hamiltonian_.h);
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
