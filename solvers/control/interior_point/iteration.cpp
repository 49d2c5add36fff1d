#include <lagroid/solvers/control/interior_point.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid {

namespace {

/// So many iterations whose gain is rounding, and none with a smaller residual, are enough.
constexpr int most_idle = 10;

}  // namespace

InteriorPoint::InteriorPoint(Transcription& transcription, ControlOptions options)
    : transcription_(transcription),
      options_(std::move(options)),
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
      first_slack_step_(multipliers_),
      rounding_(sizes_) {
  filter_.reserve(1001);
}

// ---- values, gradients, errors

InteriorPoint::Merit InteriorPoint::merit(const StageValues& values, const StageRows& slacks) const {
  Merit sum;
  for (long k = 0; k < sizes_.stages; ++k) {
    sum.barrier += values.cost[k][0];
    for (int i = 0; i < sizes_.equalities_of(k); ++i)
      sum.violation += above(rounding_.equality[k][i], values.equality[k][i]);
    for (int i = 0; i < sizes_.inequality; ++i) {
      sum.violation += above(rounding_.inequality[k][i], values.inequality[k][i] + slacks[k][i]);
      sum.barrier -= barrier_ * std::log(slacks[k][i]);
    }
  }
  return sum;
}

/// The largest part of the residual of the barrier problem's equations, relative to the multipliers' mean size.
double InteriorPoint::scaled_error(double barrier) {
  double violation = 0;
  double complementarity = 0;
  double sum = 0;
  double sum_of_bounds = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.equalities_of(k); ++i) {
      sum += std::abs(costates_[k][i]);
      violation = std::max(violation, above(rounding_.equality[k][i], values_.equality[k][i]));
    }
    for (int i = 0; i < sizes_.inequality; ++i) {
      sum_of_bounds += multipliers_[k][i];
      const double known_to = rounding_.inequality[k][i];
      violation = std::max(violation, above(known_to, values_.inequality[k][i] + slacks_[k][i]));
      complementarity =
          std::max(complementarity, above(multipliers_[k][i] * known_to, slacks_[k][i] * multipliers_[k][i] - barrier));
    }
  }
  const double bounds = double(sizes_.stages) * sizes_.inequality;
  // Multipliers of what nothing free can change may be as large as they like: they are no part of the gradient.
  const double mean = std::min((sum + sum_of_bounds) / (double(kkt_.equalities()) + bounds), rounding_.largest_term());
  const double scale = std::max(100.0, mean) / 100;
  const double mean_of_bounds = bounds > 0 ? std::min(sum_of_bounds / bounds, rounding_.largest_term()) : 0;
  const double scale_of_bounds = std::max(100.0, mean_of_bounds) / 100;
  return std::max({largest_entry(gradient_, rounding_) / scale, violation, complementarity / scale_of_bounds});
}

void InteriorPoint::evaluate() {
  transcription_.derivatives(costates_, multipliers_, derivatives_);
  lagrangian_gradient(transcription_, derivatives_, costates_, multipliers_, gradient_, rounding_);
}

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
  least_squares_costates();
  const double violation = merit(values_, slacks_).violation;
  largest_allowed_ = 1e4 * std::max(1.0, violation);
  small_violation_ = 1e-4 * std::max(1.0, violation);
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
  right_.primal = gradient_;
  negate(right_.primal);
  set_all(right_.multipliers, 0);
  kkt_.factor(1, dual_, &right_);
  ++report_.factorisations;
  kkt_.solve_eliminated(right_, step_);
  if (largest_entry(step_.multipliers) <= 1e3) costates_ = step_.multipliers;
}

// ---- the direction

/// The right-hand side of a Newton step whose residuals of equalities and of gamma + s are these.
void InteriorPoint::newton_side(const StageRows& equality, const StageRows& gap) {
  for (long k = 0; k < sizes_.stages; ++k)
    for (int i = 0; i < sizes_.inequality; ++i)
      weights_[k][i] = barrier_ / slacks_[k][i] + sigma_[k][i] * gap[k][i] - multipliers_[k][i];
  right_.primal = gradient_;
  add_inequality_gradient(transcription_, derivatives_, weights_, right_.primal);
  negate(right_.primal);
  for (std::size_t i = 0; i < equality.numbers().size(); ++i) right_.multipliers.numbers()[i] = -equality.numbers()[i];
}

/// dgamma along the displacement in `step_`.
double InteriorPoint::change_of_inequality(long stage, int i) const {
  const int n = sizes_.node;
  if (const ControlBound* bound = sizes_.bound_of(stage, i))
    return bound->sign * step_.primal.controls[stage][bound->control];
  const double* row = derivatives_.inequality[stage] + i * sizes_.variables();
  double change = row[sizes_.at_duration()] * step_.primal.durations[std::size_t(sizes_.phase_of(stage))];
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

/// Factors the assembled matrix, shifted until it has the inertia of a minimum, and eliminates right-hand sides. False
/// where no shift helps.
bool InteriorPoint::factor(const KktVector& right) {
  shift_ = 0;
  bool relaxed = false;
  for (;;) {
    const StageKkt::Inertia inertia = kkt_.factor(shift_, dual_, &right);
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
      gap_[k][i] = above(rounding_.inequality[k][i], values_.inequality[k][i] + slacks_[k][i]);
    }
  equality_ = values_.equality;
  kkt_.assemble(derivatives_, sigma_);
  set_all(dual_, 0);
  newton_side(equality_, gap_);
  if (!factor(right_)) return false;
  kkt_.solve_eliminated(right_, step_);
  slack_directions(gap_);
  return true;
}

// ---- the iteration

/// The next barrier parameters, while the barrier problem is solved well enough for its own.
void InteriorPoint::update_barrier() {
  const double last = 0.1 * options_.tolerance;
  while (barrier_ > last && scaled_error(barrier_) <= 10 * barrier_) {
    barrier_ = std::max(last, std::min(0.2 * barrier_, std::pow(barrier_, 1.5)));
    filter_.clear();
  }
}

/// False where the caller wants no more.
bool InteriorPoint::goes_on() {
  if (options_.keep_going && !options_.keep_going()) report_.status = ControlStatus::interrupted;
  return report_.status != ControlStatus::interrupted;
}

/// From where it begins, until it is converged or knows why not.
void InteriorPoint::iterate(int most_iterations) {
  most_iterations_ = most_iterations;
  if (!merit(values_, slacks_).finite()) {
    report_.status = ControlStatus::not_finite;
    return;
  }
  evaluate();
  double least_error = HUGE_VAL;
  int idle = 0;  // iterations since the last with a smaller residual
  for (; report_.iterations < most_iterations; ++report_.iterations) {
    const double error = scaled_error(0);
    if (error <= options_.tolerance) {
      report_.status = ControlStatus::converged;
      return;
    }
    if (!goes_on()) return;
    idle = error < 0.9 * least_error ? 0 : idle + 1;
    least_error = std::min(error, least_error);
    if (idle > most_idle && gains_rounding_) {
      report_.status = ControlStatus::stagnated;
      return;
    }
    update_barrier();
    if (!direction()) {
      report_.status = ControlStatus::singular;
      return;
    }
    if (line_search() == Outcome::stuck) {
      if (largest_violation(sizes_, values_, rounding_) <= options_.tolerance) {
        report_.status = ControlStatus::stagnated;
        return;
      }
      if (!restore()) {
        if (goes_on() && report_.iterations < most_iterations) report_.status = ControlStatus::infeasible;
        return;
      }
      if (report_.iterations >= most_iterations) {  // restoration took the rest of them
        evaluate();
        return;
      }
    }
    evaluate();
  }
}

ControlReport InteriorPoint::solve() {
  begin();
  iterate(options_.max_iterations);
  judge();
  return report_;
}

ControlReport InteriorPoint::resume(int most_iterations) {
  begin_again();
  iterate(most_iterations);
  if (report_.status == ControlStatus::not_converged && scaled_error(0) <= options_.tolerance)
    report_.status = ControlStatus::converged;  // by the last iteration that it is allowed
  describe();
  return report_;
}

}  // namespace lagroid
