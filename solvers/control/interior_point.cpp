#include <lagroid/solvers/control/interior_point.hpp>

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

}  // namespace

bool InteriorPoint::Merit::finite() const { return std::isfinite(violation) && std::isfinite(barrier); }

double InteriorPoint::KktError::largest() const { return std::max({stationarity, violation, complementarity}); }

InteriorPoint::InteriorPoint(Transcription& transcription, ControlOptions options)
    : transcription_(transcription),
      options_(options),
      sizes_(transcription.sizes()),
      kkt_(transcription),
      values_(sizes_),
      trial_(sizes_),
      derivatives_(sizes_),
      costates_(sizes_.stages, sizes_.equality),
      multipliers_(sizes_.stages, sizes_.inequality),
      slacks_(multipliers_),
      trial_slacks_(multipliers_),
      sigma_(multipliers_),
      weights_(multipliers_),
      dual_(costates_),
      slack_step_(multipliers_),
      multiplier_step_(multipliers_),
      equality_(costates_),
      gap_(multipliers_),
      gradient_(sizes_),
      right_(sizes_),
      step_(sizes_),
      first_step_(sizes_),
      first_slack_step_(multipliers_) {
  filter_.reserve(1001);
}

// ---- values, gradients, errors

InteriorPoint::Merit InteriorPoint::merit(const StageValues& values, const StageRows& slacks) const {
  Merit sum;
  for (long k = 0; k < sizes_.stages; ++k) {
    sum.barrier += values.cost[k][0];
    for (int i = 0; i < sizes_.equalities_of(k); ++i) sum.violation += std::abs(values.equality[k][i]);
    for (int i = 0; i < sizes_.inequality; ++i) {
      sum.violation += std::abs(values.inequality[k][i] + slacks[k][i]);
      sum.barrier -= barrier_ * std::log(slacks[k][i]);
    }
  }
  return sum;
}

double InteriorPoint::largest_violation() const {
  double largest = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const auto take = [&](double x) { largest = std::isnan(x) ? HUGE_VAL : std::max(largest, x); };
    for (int i = 0; i < sizes_.equalities_of(k); ++i) take(std::abs(values_.equality[k][i]));
    for (int i = 0; i < sizes_.inequality; ++i) take(values_.inequality[k][i]);
  }
  return largest;
}

/// d(l + <costates, phi> + <weights, gamma>) along displacements; zero along what is fixed.
void InteriorPoint::lagrangian_gradient(const StageRows& costates, const StageRows& weights,
                                        TrajectoryDisplacement& out) const {
  const int n = sizes_.node;
  const int d = sizes_.variables();
  std::fill(out.nodes.numbers().begin(), out.nodes.numbers().end(), 0.0);
  out.duration = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const auto component = [&](int q) {
      double sum = derivatives_.gradient[k][q];
      for (int i = 0; i < sizes_.equalities_of(k); ++i) sum += costates[k][i] * derivatives_.equality[k][i * d + q];
      for (int i = 0; i < sizes_.inequality; ++i) sum += weights[k][i] * derivatives_.inequality[k][i * d + q];
      return sum;
    };
    for (int i = 0; i < n; ++i) {
      out.nodes[k][i] += component(i);
      out.nodes[k + 1][i] += component(n + i);
    }
    for (int i = 0; i < sizes_.control; ++i) out.controls[k][i] = component(sizes_.at_control() + i);
    out.duration += component(sizes_.at_duration());
  }
  for (int i = 0; i < n; ++i) {
    if (!transcription_.free_start()[std::size_t(i)]) out.nodes[0][i] = 0;
    if (!transcription_.free_end()[std::size_t(i)]) out.nodes[sizes_.stages][i] = 0;
  }
  if (!transcription_.duration_is_free()) out.duration = 0;
}

InteriorPoint::KktError InteriorPoint::error(double barrier) {
  lagrangian_gradient(costates_, multipliers_, gradient_);
  KktError out;
  double sum = 0;
  double sum_of_bounds = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.equalities_of(k); ++i) {
      sum += std::abs(costates_[k][i]);
      out.violation = std::max(out.violation, std::abs(values_.equality[k][i]));
    }
    for (int i = 0; i < sizes_.inequality; ++i) {
      sum_of_bounds += multipliers_[k][i];
      out.violation = std::max(out.violation, std::abs(values_.inequality[k][i] + slacks_[k][i]));
      out.complementarity = std::max(out.complementarity, std::abs(slacks_[k][i] * multipliers_[k][i] - barrier));
    }
  }
  const double bounds = double(sizes_.stages) * sizes_.inequality;
  const double scale = std::max(100.0, (sum + sum_of_bounds) / (double(kkt_.equalities()) + bounds)) / 100;
  const double scale_of_bounds = bounds > 0 ? std::max(100.0, sum_of_bounds / bounds) / 100 : 1;
  out.stationarity = largest_entry(gradient_) / scale;
  out.complementarity /= scale_of_bounds;
  return out;
}

void InteriorPoint::evaluate() { transcription_.derivatives(costates_, multipliers_, derivatives_); }

// ---- the start

void InteriorPoint::begin() {
  report_ = {};
  barrier_ = options_.first_barrier;
  last_shift_ = 0;
  filter_.clear();
  transcription_.values(values_);
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i) {
      slacks_[k][i] = std::max(-values_.inequality[k][i], options_.least_slack);
      multipliers_[k][i] = barrier_ / slacks_[k][i];
    }
  if (sizes_.inequality == 0) barrier_ = 0.1 * options_.tolerance;
  const double violation = merit(values_, slacks_).violation;
  largest_allowed_ = 1e4 * std::max(1.0, violation);
  small_violation_ = 1e-4 * std::max(1.0, violation);
  least_squares_costates();
}

void InteriorPoint::begin_again() {
  report_ = {};
  barrier_ = sizes_.inequality == 0 ? 0.1 * options_.tolerance : options_.resumed_barrier;
  last_shift_ = 0;
  filter_.clear();
  transcription_.values(values_);
  // Of an inequality that was active, s = mu / z; of another, its own distance, but no less than at any start.
  for (std::size_t i = 0; i < slacks_.numbers().size(); ++i) {
    double& s = slacks_.numbers()[i];
    double& z = multipliers_.numbers()[i];
    s = std::max(-values_.inequality.numbers()[i],
                 z > 0 ? std::min(barrier_ / z, options_.least_slack) : options_.least_slack);
    z = barrier_ / s;
  }
  const double violation = merit(values_, slacks_).violation;
  largest_allowed_ = 1e4 * std::max(1.0, violation);
  small_violation_ = 1e-4 * std::max(1.0, violation);
}

void InteriorPoint::take_multipliers(const StageRows& costates, const StageRows& of_inequalities) {
  costates_ = costates;
  multipliers_ = of_inequalities;
}

void InteriorPoint::move_on() {
  for (StageRows* rows : {&costates_, &multipliers_}) std::copy((*rows)[1], (*rows)[sizes_.stages], (*rows)[0]);
}

/// lambda that minimises |d(l + <lambda, phi> + <z, gamma>)|; zero where that is large, as where rows of dphi are
/// nearly dependent.
void InteriorPoint::least_squares_costates() {
  set_all(costates_, 0);
  evaluate();
  set_all(sigma_, 0);
  kkt_.assemble(derivatives_, sigma_, StageKkt::HessianPart::none);
  set_all(dual_, 0);
  kkt_.factor(1, dual_);
  ++report_.factorisations;
  lagrangian_gradient(costates_, multipliers_, right_.primal);
  negate(right_.primal);
  set_all(right_.multipliers, 0);
  kkt_.solve(right_, step_);
  if (largest_entry(step_.multipliers) <= 1e3) costates_ = step_.multipliers;
}

// ---- the direction

/// The right-hand side of a Newton step whose residuals of equalities and of gamma + s are these.
void InteriorPoint::newton_side(const StageRows& equality, const StageRows& gap) {
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i) weights_[k][i] = barrier_ / slacks_[k][i] + sigma_[k][i] * gap[k][i];
  lagrangian_gradient(costates_, weights_, right_.primal);
  negate(right_.primal);
  for (std::size_t i = 0; i < equality.numbers().size(); ++i) right_.multipliers.numbers()[i] = -equality.numbers()[i];
}

/// dgamma along the displacement in `step_`.
double InteriorPoint::change_of_inequality(long stage, int i) const {
  const int n = sizes_.node;
  const double* row = derivatives_.inequality[stage] + i * sizes_.variables();
  double change = row[sizes_.at_duration()] * step_.primal.duration;
  for (int q = 0; q < n; ++q)
    change += row[q] * step_.primal.nodes[stage][q] + row[n + q] * step_.primal.nodes[stage + 1][q];
  for (int q = 0; q < sizes_.control; ++q) change += row[sizes_.at_control() + q] * step_.primal.controls[stage][q];
  return change;
}

/// ds and dz that belong to the displacement in `step_`.
void InteriorPoint::slack_directions(const StageRows& gap) {
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i) {
      slack_step_[k][i] = -gap[k][i] - change_of_inequality(k, i);
      multiplier_step_[k][i] = barrier_ / slacks_[k][i] - multipliers_[k][i] - sigma_[k][i] * slack_step_[k][i];
    }
}

/// Factors the assembled matrix, shifted until it has the inertia of a minimum. False where no shift helps.
bool InteriorPoint::factor() {
  shift_ = 0;
  bool relaxed = false;
  for (;;) {
    const StageKkt::Inertia inertia = kkt_.factor(shift_, dual_);
    ++report_.factorisations;
    const bool singular = !(inertia.smallest > 1e-18);
    if (!singular && inertia.negative == kkt_.equalities()) break;
    if (singular && !relaxed) {
      for (double& x : dual_.numbers()) x += 1e-8 * std::pow(std::max(barrier_, 1e-16), 0.25);
      relaxed = true;
    }
    shift_ = shift_ > 0        ? (last_shift_ > 0 ? 8 : 100) * shift_
             : last_shift_ > 0 ? std::max(1e-20, last_shift_ / 3)
                               : 1e-4;
    if (shift_ > 1e40) return false;
  }
  if (shift_ > 0) last_shift_ = shift_;
  return true;
}

/// The Newton direction, of a matrix shifted until it has the inertia of a minimum. False where no shift helps.
bool InteriorPoint::direction() {
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i) {
      sigma_[k][i] = multipliers_[k][i] / slacks_[k][i];
      gap_[k][i] = values_.inequality[k][i] + slacks_[k][i];
    }
  equality_ = values_.equality;
  kkt_.assemble(derivatives_, sigma_);
  set_all(dual_, 0);
  if (!factor()) return false;
  newton_side(equality_, gap_);
  kkt_.solve(right_, step_);
  slack_directions(gap_);
  return true;
}

double InteriorPoint::fraction_to_boundary(const StageRows& at, const StageRows& along) const {
  const double keep = std::max(0.99, 1 - barrier_);
  double fraction = 1;
  for (std::size_t i = 0; i < at.numbers().size(); ++i)
    if (const double step = along.numbers()[i]; step < 0) fraction = std::min(fraction, -keep * at.numbers()[i] / step);
  return fraction;
}

/// d(cost - mu sum log s) along the step.
double InteriorPoint::slope() const {
  const int n = sizes_.node;
  double sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* g = derivatives_.gradient[k];
    for (int q = 0; q < n; ++q) sum += g[q] * step_.primal.nodes[k][q] + g[n + q] * step_.primal.nodes[k + 1][q];
    for (int q = 0; q < sizes_.control; ++q) sum += g[sizes_.at_control() + q] * step_.primal.controls[k][q];
    sum += g[sizes_.at_duration()] * step_.primal.duration;
    for (int i = 0; i < sizes_.inequality; ++i) sum -= barrier_ * slack_step_[k][i] / slacks_[k][i];
  }
  return sum;
}

// ---- the filter line search

InteriorPoint::Merit InteriorPoint::try_step(double fraction) {
  transcription_.try_displacement(step_.primal, fraction);
  transcription_.values(trial_);
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i)
      // A slack below the constraint's own distance only adds to violation and barrier.
      trial_slacks_[k][i] = std::max(slacks_[k][i] + fraction * slack_step_[k][i], -trial_.inequality[k][i]);
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
  const double round_off = 10 * epsilon * std::abs(now.barrier);
  const bool descends = slope < 0 && fraction * std::pow(-slope, 2.3) > std::pow(now.violation, 1.1);
  if (now.violation <= small_violation_ && descends)
    return trial.barrier <= now.barrier + armijo * fraction * slope + round_off;
  return trial.violation <= (1 - filter_violation) * now.violation ||
         trial.barrier <= now.barrier - filter_barrier * now.violation + round_off;
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

InteriorPoint::Outcome InteriorPoint::line_search() {
  const Merit now = merit(values_, slacks_);
  const double slope = this->slope();
  const double most = fraction_to_boundary(slacks_, slack_step_);
  const auto remember = [&](const Merit& trial, double fraction) {
    const bool descends = slope < 0 && fraction * std::pow(-slope, 2.3) > std::pow(now.violation, 1.1);
    const bool armijo_step = descends && trial.barrier <= now.barrier + armijo * fraction * slope;
    if (!armijo_step)
      filter_.push_back({(1 - filter_violation) * now.violation, now.barrier - filter_barrier * now.violation});
    take(fraction);
  };

  // Near the solution only round-off is left to compare.
  if (largest_entry(step_.primal) < 10 * epsilon) {
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

  bool first = true;
  for (double fraction = most; fraction > least; fraction /= 2) {
    const Merit trial = try_step(fraction);
    if (acceptable(now, trial, slope, fraction)) {
      remember(trial, fraction);
      return Outcome::advanced;
    }
    if (first && trial.finite() && trial.violation >= now.violation) {
      // Second-order corrections: the constraints' curvature, measured at the trial, is taken off the direction.
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
        corrected_fraction = fraction_to_boundary(slacks_, slack_step_);
        const Merit corrected = try_step(corrected_fraction);
        if (acceptable(now, corrected, slope, fraction)) {
          remember(corrected, corrected_fraction);
          return Outcome::advanced;
        }
        if (!(corrected.violation < 0.99 * before)) break;
        before = corrected.violation;
      }
      step_ = first_step_;
      slack_step_ = first_slack_step_;
    }
    first = false;
  }
  filter_.push_back({(1 - filter_violation) * now.violation, now.barrier - filter_barrier * now.violation});
  return Outcome::stuck;
}

// ---- the iteration

/// The next barrier parameters, while the barrier problem is solved well enough for its own.
void InteriorPoint::update_barrier() {
  const double last = 0.1 * options_.tolerance;
  while (barrier_ > last && error(barrier_).largest() <= 10 * barrier_) {
    barrier_ = std::max(last, std::min(0.2 * barrier_, std::pow(barrier_, 1.5)));
    filter_.clear();
  }
}

/// From where it begins, until it is converged or knows why not.
void InteriorPoint::iterate(int most_iterations) {
  most_iterations_ = most_iterations;
  if (!merit(values_, slacks_).finite()) {
    report_.status = ControlStatus::not_finite;
    return;
  }
  evaluate();
  for (; report_.iterations < most_iterations; ++report_.iterations) {
    if (error(0).largest() <= options_.tolerance) {
      report_.status = ControlStatus::converged;
      return;
    }
    update_barrier();
    if (!direction()) {
      report_.status = ControlStatus::singular;
      return;
    }
    if (line_search() == Outcome::stuck) {
      if (largest_violation() <= options_.tolerance) {
        report_.status = ControlStatus::stagnated;
        return;
      }
      if (!restore()) {
        if (report_.iterations < most_iterations) report_.status = ControlStatus::infeasible;
        return;
      }
    }
    evaluate();
  }
}

ControlReport InteriorPoint::solve() {
  begin();
  iterate(options_.max_iterations);
  if (report_.converged()) report_.is_strict_minimum = direction() && shift_ == 0;
  describe();
  explain();
  return report_;
}

ControlReport InteriorPoint::resume(int most_iterations) {
  begin_again();
  iterate(most_iterations);
  if (report_.status == ControlStatus::not_converged && error(0).largest() <= options_.tolerance)
    report_.status = ControlStatus::converged;  // by the last iteration that it is allowed
  describe();
  return report_;
}

}  // namespace lagroid
