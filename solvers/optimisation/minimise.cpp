#include <lagroid/solvers/optimisation/minimise.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lagroid::optimisation {

std::string_view to_string(MinimisationStatus outcome) {
  switch (outcome) {
    case MinimisationStatus::converged:
      return "converged";
    case MinimisationStatus::stagnated:
      return "stagnated";
    case MinimisationStatus::stationary_start:
      return "stationary_start";
    case MinimisationStatus::iteration_limit:
      return "iteration_limit";
    case MinimisationStatus::time_limit:
      return "time_limit";
    case MinimisationStatus::interrupted:
      return "interrupted";
    case MinimisationStatus::infeasible_start:
      return "infeasible_start";
    case MinimisationStatus::off_manifold:
      return "off_manifold";
    case MinimisationStatus::not_finite:
      return "not_finite";
    case MinimisationStatus::no_step:
      return "no_step";
  }
  return "unknown";
}

void Problem::evaluate(EvaluatedPoint& state) {
  ++evaluations_.gradients;
  state.euclidean.resize(state.x.size());
  state.value = objective_.evaluate(state.x, state.euclidean);
  state.gradient = state.euclidean;
  manifold_.gradient(state.x, state.gradient);
}

double Problem::value(const Point& x) {
  ++evaluations_.values;
  return objective_.value(x);
}

void Problem::hessian(const EvaluatedPoint& state, const Vector& v, Vector& h) {
  ++evaluations_.hessians;
  objective_.hessian(state.x, v, h);
  manifold_.hessian(state.x, state.euclidean, v, h);
}

namespace {

bool finite(const Manifold& manifold, const EvaluatedPoint& state) {
  return std::isfinite(state.value) && std::isfinite(manifold.inner(state.x, state.gradient, state.gradient));
}

/// Whether anything still falls.
class Progress {
 public:
  bool stalled(double value, double gradient, long patience) {
    if (value < value_ || gradient < gradient_) {
      value_ = std::min(value_, value);
      gradient_ = std::min(gradient_, gradient);
      since_ = 0;
      return false;
    }
    return ++since_ >= patience && patience > 0;
  }

 private:
  double value_ = std::numeric_limits<double>::infinity();
  double gradient_ = std::numeric_limits<double>::infinity();
  long since_ = 0;
};

}  // namespace

Result minimise(const Manifold& manifold, const Objective& objective, const Point& start, DescentMethod& method,
                const Stopping& stopping, const Recording& recording) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  Problem problem(manifold, objective);
  Result out;
  out.x = start;
  const auto end = [&](MinimisationStatus outcome, std::string message = {}) {
    out.outcome = outcome;
    out.message = std::move(message);
    out.seconds = seconds();
    out.evaluations = problem.evaluations();
    out.residual = manifold.residual(out.x);
    return out;
  };

  const double off = start.size() == manifold.size() ? manifold.residual(start) : INFINITY;
  constexpr double on_it = 1e-8;
  if (start.size() == manifold.size() && !start.allFinite())
    return end(MinimisationStatus::not_finite, "the start is not finite; give numbers");
  if (start.size() != manifold.size()) {
    out.outcome = MinimisationStatus::infeasible_start;
    out.message = fmt::format("the start has {} numbers, points of the {} have {}", start.size(), manifold.name(),
                              manifold.size());
    return out;
  }
  if (!(off <= on_it))
    return end(MinimisationStatus::infeasible_start,
               fmt::format("the start is off the {} by {:.1e}; begin at its nearest point", manifold.name(), off));

  EvaluatedPoint state;
  state.x = start;
  problem.evaluate(state);
  if (!finite(manifold, state))
    return end(MinimisationStatus::not_finite, "value or gradient at the start are not finite; look at the data");
  out.value = state.value;
  out.gradient = manifold.norm(state.x, state.gradient);
  // What rounding leaves of a gradient that vanishes; with a metric of its own its norm has not the unit of |D f|.
  const double rounding =
      manifold.has_own_metric() ? 0 : 4e-15 * std::sqrt(double(manifold.size())) * state.euclidean.norm();
  if (out.gradient <= rounding)
    return out.value <= stopping.value || objective.convex()
               ? end(MinimisationStatus::converged)
               : end(MinimisationStatus::stationary_start,
                     "the gradient vanishes at the start, which need not be a minimum; begin elsewhere");

  Progress progress;
  const auto record = [&](long iteration) {
    const Iterate now{iteration, state.value, manifold.norm(state.x, state.gradient), seconds(), problem.evaluations()};
    if (recording.history) out.history.push_back(now);
    if (state.value <= out.value) {
      out.x = state.x;
      out.value = state.value;
      out.gradient = now.gradient;
    }
    out.iterations = iteration;
    return now;
  };
  const double small = std::max(stopping.gradient, stopping.relative_gradient * out.gradient);
  Iterate now = record(0);
  method.begin(problem, state);
  for (long k = 0;; ++k) {
    if (recording.callback && !recording.callback(now, state.x))
      return end(MinimisationStatus::interrupted,
                 fmt::format("interrupted after {} iterations; go on from the best point", k));
    if ((small > 0 && now.gradient <= small) || now.value <= stopping.value) {
      out.x = state.x;
      out.value = now.value;
      out.gradient = now.gradient;
      return end(MinimisationStatus::converged);
    }
    if (progress.stalled(now.value, now.gradient, stopping.patience))
      return end(MinimisationStatus::stagnated,
                 fmt::format("neither value nor gradient fell in {} iterations; |grad f| = {:.1e} is "
                             "what rounding or the method leaves",
                             stopping.patience, out.gradient));
    if (k == stopping.iterations)
      return end(MinimisationStatus::iteration_limit,
                 fmt::format("{} iterations did not suffice, |grad f| = {:.1e}; allow more, or take another method", k,
                             out.gradient));
    if (seconds() > stopping.seconds)
      return end(MinimisationStatus::time_limit,
                 fmt::format("{:g} s did not suffice, |grad f| = {:.1e}; allow more, or take another method",
                             stopping.seconds, out.gradient));
    if (method.advance(problem, state) == StepOutcome::none)
      return end(MinimisationStatus::no_step,
                 fmt::format("{} finds no step after {} iterations; take a smaller one or another "
                             "method",
                             method.name(), k));
    if (!finite(manifold, state))
      return end(MinimisationStatus::not_finite,
                 fmt::format("{} left all numbers after {} iterations; take a smaller step", method.name(), k + 1));
    now = record(k + 1);
  }
}

}  // namespace lagroid::optimisation
