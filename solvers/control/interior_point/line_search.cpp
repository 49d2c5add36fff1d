// The line search by a filter: a step is taken where no earlier iterate was better in both, violation and barrier
// function.
#include <lagroid/solvers/control/interior_point.hpp>
#include <lagroid/solvers/control/interior_point/step_limit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Constants of the filter method, as in Waechter and Biegler (2006), table 2.
constexpr double filter_violation = 1e-5;  // gamma_theta
constexpr double filter_barrier = 1e-8;    // gamma_phi
constexpr double armijo = 1e-8;            // eta_phi
constexpr int most_corrections = 4;
/// A slack may shrink to a thousandth in one step, as barrier parameters do, and no further: one that a step past its
/// bound leaves at 1e-11 of what it was holds all later steps back.
constexpr double most_to_boundary = 0.999;

/// Whether the barrier function is to fall by more than the violation is worth.
bool descends(double violation, double slope, double fraction) {
  return slope < 0 && fraction * std::pow(-slope, 2.3) > std::pow(violation, 1.1);
}

}  // namespace

bool InteriorPoint::Merit::finite() const { return std::isfinite(violation) && std::isfinite(barrier); }

double InteriorPoint::fraction_to_boundary(const StageRows& at, const StageRows& along) const {
  const double keep = std::clamp(1 - barrier_, 0.99, most_to_boundary);
  double fraction = 1;
  for (std::size_t i = 0; i < at.numbers().size(); ++i)
    if (const double step = along.numbers()[i]; step < 0) fraction = std::min(fraction, -keep * at.numbers()[i] / step);
  return fraction;
}

double InteriorPoint::largest_fraction() const {
  return std::min(fraction_to_boundary(slacks_, slack_step_), detail::fraction_of_durations(step_.primal));
}

/// d(cost - mu sum log s) along the step.
double InteriorPoint::slope() const {
  const int n = sizes_.node;
  double sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* g = derivatives_.gradient[k];
    for (int q = 0; q < n; ++q) sum += g[q] * step_.primal.nodes[k][q] + g[n + q] * step_.primal.nodes[k + 1][q];
    for (int q = 0; q < sizes_.control; ++q) sum += g[sizes_.at_control() + q] * step_.primal.controls[k][q];
    sum += g[sizes_.at_duration()] * step_.primal.durations[std::size_t(sizes_.phase_of(k))];
    for (int i = 0; i < sizes_.inequality; ++i) sum -= barrier_ * slack_step_[k][i] / slacks_[k][i];
  }
  return sum;
}

InteriorPoint::Merit InteriorPoint::try_step(double fraction) {
  transcription_.try_displacement(step_.primal, fraction);
  transcription_.values(trial_);
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i)
      // A slack below the constraint's own distance only adds to violation and barrier; one below its rounding adds to
      // the barrier alone, without end where nothing free can change the constraint.
      trial_slacks_[k][i] = std::max(
          {slacks_[k][i] + fraction * slack_step_[k][i], -trial_.inequality[k][i], rounding_.inequality[k][i]});
  return merit(trial_, trial_slacks_);
}

bool InteriorPoint::accepted_by_filter(const Merit& trial) const {
  if (!trial.finite() || trial.violation > largest_allowed_) return false;
  return std::none_of(filter_.begin(), filter_.end(), [&](const Merit& entry) {
    return trial.violation >= entry.violation && trial.barrier >= entry.barrier;
  });
}

/// Whether a trial improves enough on where the trajectory stands: the barrier function by Armijo's rule where the
/// violation is small, else one of the two.
bool InteriorPoint::acceptable(const Merit& now, const Merit& trial, double slope, double fraction) const {
  if (!accepted_by_filter(trial)) return false;
  if (now.violation <= small_violation_ && descends(now.violation, slope, fraction))
    return trial.barrier <= now.barrier + armijo * fraction * slope + merit_rounding_;
  return trial.violation <= (1 - filter_violation) * now.violation ||
         trial.barrier <= now.barrier - filter_barrier * now.violation + merit_rounding_;
}

void InteriorPoint::take(double fraction) {
  transcription_.accept();
  std::swap(values_, trial_);
  std::swap(slacks_, trial_slacks_);
  add(costates_, fraction, step_.multipliers);
  const double of_multipliers = fraction_to_boundary(multipliers_, multiplier_step_);
  for (std::size_t i = 0; i < multipliers_.numbers().size(); ++i) {
    double& z = multipliers_.numbers()[i];
    const double balanced = barrier_ / slacks_.numbers()[i];
    z = std::clamp(z + of_multipliers * multiplier_step_.numbers()[i], 1e-10 * balanced, 1e10 * balanced);
  }
}

/// What no later iterate is to be worse than.
void InteriorPoint::add_to_filter(const Merit& now) {
  filter_.push_back({(1 - filter_violation) * now.violation, now.barrier - filter_barrier * now.violation});
}

/// What the barrier function is known to: its own rounding, and where only rounding violates constraints, what that
/// costs.
double InteriorPoint::merit_rounding(const Merit& now) const {
  double sum = KktRounding::ulps * std::abs(now.barrier);
  if (now.violation > 0) return sum;
  for (std::size_t i = 0; i < costates_.numbers().size(); ++i)
    sum += std::abs(costates_.numbers()[i]) * rounding_.equality.numbers()[i];
  for (std::size_t i = 0; i < multipliers_.numbers().size(); ++i)
    sum += multipliers_.numbers()[i] * rounding_.inequality.numbers()[i];
  return sum;
}

/// Takes a trial; the filter remembers where it came from unless the barrier function fell by Armijo's rule.
void InteriorPoint::take_trial(const Merit& now, const Merit& trial, double slope, double fraction) {
  const bool armijo_step = descends(now.violation, slope, fraction) &&
                           trial.barrier <= now.barrier + armijo * fraction * slope + merit_rounding_;
  if (!armijo_step) add_to_filter(now);
  take(fraction);
}

/// Second-order corrections: the constraints' curvature, measured at the trial, is taken off the direction. Where none
/// is acceptable, the direction is again what it was.
bool InteriorPoint::take_corrected(const Merit& now, double slope, double fraction) {
  first_step_ = step_;
  first_slack_step_ = slack_step_;
  double before = now.violation;
  double corrected_fraction = fraction;
  for (int i = 0; i < most_corrections; ++i) {
    for (std::size_t j = 0; j < equality_.numbers().size(); ++j)
      equality_.numbers()[j] = corrected_fraction * equality_.numbers()[j] + trial_.equality.numbers()[j];
    for (std::size_t j = 0; j < gap_.numbers().size(); ++j)
      gap_.numbers()[j] =
          corrected_fraction * gap_.numbers()[j] + trial_.inequality.numbers()[j] + trial_slacks_.numbers()[j];
    newton_side(equality_, gap_);
    kkt_.solve(right_, step_);
    slack_directions(gap_);
    corrected_fraction = largest_fraction();
    const Merit corrected = try_step(corrected_fraction);
    if (acceptable(now, corrected, slope, fraction)) {
      take_trial(now, corrected, slope, corrected_fraction);
      return true;
    }
    if (!(corrected.violation < 0.99 * before)) break;
    before = corrected.violation;
  }
  step_ = first_step_;
  slack_step_ = first_slack_step_;
  return false;
}

InteriorPoint::Outcome InteriorPoint::line_search() {
  const Merit now = merit(values_, slacks_);
  const double slope = this->slope();
  const double most = largest_fraction();

  merit_rounding_ = merit_rounding(now);
  gains_rounding_ = now.violation == 0 && std::abs(slope) <= merit_rounding_;

  // Near the solution only round-off is left to compare. Elsewhere constraints that are dependent allow no step.
  if (largest_entry(step_.primal) < 10 * epsilon) {
    if (largest_violation(sizes_, values_, rounding_) > options_.tolerance) {
      add_to_filter(now);
      return Outcome::stuck;
    }
    try_step(most);
    take(most);
    return Outcome::advanced;
  }

  double least = 0.05 * filter_violation;
  if (slope < 0) {
    least = 0.05 * std::min(filter_violation, filter_barrier * now.violation / -slope);
    if (now.violation <= small_violation_)
      least = std::min(least, 0.05 * std::pow(now.violation, 1.1) / std::pow(-slope, 2.3));
  }
  least = std::max(least, 1e-12);

  for (double fraction = most; fraction > least; fraction /= 2) {
    const Merit trial = try_step(fraction);
    if (acceptable(now, trial, slope, fraction)) {
      take_trial(now, trial, slope, fraction);
      return Outcome::advanced;
    }
    const bool is_first = fraction == most;
    if (is_first && trial.finite() && trial.violation >= now.violation && take_corrected(now, slope, fraction))
      return Outcome::advanced;
  }
  add_to_filter(now);
  return Outcome::stuck;
}

}  // namespace lagroid
