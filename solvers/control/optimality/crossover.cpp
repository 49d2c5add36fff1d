#include <lagroid/solvers/control/optimality/crossover.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid {

namespace {

constexpr int most_changes = 20;
constexpr int most_iterations = 12;      // of Newton's method, for one choice of active inequalities
constexpr double least_pivot = 1e-12;    // of a matrix that need not be shifted
constexpr double proximal_shift = 1e-8;  // of one that must
constexpr double round_off = 1e-13;
constexpr double sure = 1e4;  // z / s of an inequality that is active without doubt

TranscriptionSizes padded(TranscriptionSizes sizes) {
  sizes.equality += sizes.inequality;
  sizes.inequality = 0;
  for (TranscriptionPhase& phase : sizes.phases) phase.bounds.clear();
  return sizes;
}

}  // namespace

Crossover::Crossover(Transcription& transcription, std::function<bool()> keep_going)
    : transcription_(transcription),
      keep_going_(std::move(keep_going)),
      sizes_(transcription.sizes()),
      padded_sizes_(padded(sizes_)),
      kkt_(transcription, padded_sizes_),
      values_(sizes_),
      derivatives_(sizes_),
      padded_(padded_sizes_),
      costates_(sizes_.stages, sizes_.equality),
      multipliers_(sizes_.stages, sizes_.inequality),
      slacks_(multipliers_),
      active_(multipliers_.numbers().size()),
      no_inequalities_(sizes_.stages, 0),
      dual_(sizes_.stages, padded_sizes_.equality),
      gradient_(sizes_),
      right_(padded_sizes_),
      step_(padded_sizes_) {}

/// Under strict complementarity one of s and z is far above the other: those are active whose z is above s by a factor.
void Crossover::guess_active(double factor) {
  for (std::size_t i = 0; i < active_.size(); ++i) {
    active_[i] = multipliers_.numbers()[i] > factor * slacks_.numbers()[i];
    if (!active_[i]) multipliers_.numbers()[i] = 0;
  }
}

void Crossover::evaluate() {
  transcription_.values(values_);
  transcription_.derivatives(costates_, multipliers_, derivatives_);
}

/// Of the equations that are solved: |gamma| of those that are active.
KktResidual Crossover::residual_of_active() {
  lagrangian_gradient(transcription_, derivatives_, costates_, multipliers_, gradient_);
  KktResidual out;
  out.stationarity = largest_entry(gradient_);
  out.violation = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const auto take = [&](double x) { out.violation = larger_magnitude(out.violation, x); };
    for (int i = 0; i < sizes_.equalities_of(k); ++i) take(values_.equality[k][i]);
    for (int i = 0; i < sizes_.inequality; ++i)
      if (active(k, i)) take(values_.inequality[k][i]);
  }
  return out;
}

void Crossover::assemble() {
  const int d = sizes_.variables();
  const int gamma = sizes_.inequality * d;
  padded_.gradient = derivatives_.gradient;
  padded_.hessian = derivatives_.hessian;
  for (long k = 0; k < sizes_.stages; ++k) {
    double* rows = padded_.equality[k];
    for (int i = 0; i < sizes_.inequality; ++i) {
      std::fill(rows + i * d, rows + (i + 1) * d, 0.0);
      if (!active(k, i)) continue;
      if (const ControlBound* bound = sizes_.bound_of(k, i)) {
        rows[i * d + sizes_.at_control() + bound->control] = bound->sign;
      } else {
        std::copy(derivatives_.inequality[k] + i * d, derivatives_.inequality[k] + (i + 1) * d, rows + i * d);
      }
    }
    std::copy(derivatives_.equality[k], derivatives_.equality[k] + sizes_.equality * d, rows + gamma);
  }
  kkt_.assemble(padded_, no_inequalities_);
}

/// False where the matrix has not the inertia of a minimum.
bool Crossover::factor() {
  struct Shifts {
    double primal, dual;
  };
  for (const Shifts shifts : {Shifts{0, 0}, Shifts{0, proximal_shift}, Shifts{proximal_shift, proximal_shift}}) {
    for (long k = 0; k < sizes_.stages; ++k)
      for (int i = 0; i < padded_sizes_.equality; ++i)
        dual_[k][i] = i < sizes_.inequality && !active(k, i) ? 1 : shifts.dual;
    const StageKkt::Inertia inertia = kkt_.factor(shifts.primal, dual_);
    if (inertia.smallest > least_pivot && inertia.negative == kkt_.equalities()) return true;
  }
  return false;
}

void Crossover::step() {
  right_.primal = gradient_;
  negate(right_.primal);
  for (long k = 0; k < sizes_.stages; ++k) {
    double* rows = right_.multipliers[k];
    for (int i = 0; i < sizes_.inequality; ++i) rows[i] = active(k, i) ? -values_.inequality[k][i] : 0;
    for (int i = 0; i < sizes_.equality; ++i)
      rows[sizes_.inequality + i] = i < sizes_.equalities_of(k) ? -values_.equality[k][i] : 0;
  }
  kkt_.solve(right_, step_);
  transcription_.try_displacement(step_.primal, 1);
  transcription_.accept();
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* change = step_.multipliers[k];
    for (int i = 0; i < sizes_.inequality; ++i)
      if (active(k, i)) multipliers_[k][i] += change[i];
    for (int i = 0; i < sizes_.equalities_of(k); ++i) costates_[k][i] += change[sizes_.inequality + i];
  }
}

/// Newton's method until only round-off is left, which shows in a residual that no longer falls.
Crossover::Outcome Crossover::solve_for_active(CrossoverReport& report) {
  double last = residual_of_active().largest();
  for (int i = 0; i < most_iterations; ++i) {
    if (keep_going_ && !keep_going_()) return Outcome::interrupted;
    assemble();
    if (!factor()) return Outcome::wrong_inertia;
    step();
    ++report.iterations;
    evaluate();
    const double now = residual_of_active().largest();
    if (!std::isfinite(now) || now > 1e3 * (last + 1e-6)) return Outcome::diverged;
    if (now <= round_off || (now > 0.5 * last && now <= 1e-9)) break;
    last = now;
  }
  return Outcome::solved;
}

/// Lets go what has the wrong sign, and takes in what is violated. False where there is nothing to change.
bool Crossover::change_active() {
  const double tiny = round_off * std::max(1.0, largest_entry(multipliers_));
  bool changed = false;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    double& z = multipliers_.numbers()[i];
    if (active_[i] && z < -tiny) {
      active_[i] = false;
      changed = true;
    } else if (!active_[i] && values_.inequality.numbers()[i] > round_off) {
      active_[i] = true;
      changed = true;
    }
    if (!active_[i] || z < 0) z = 0;
  }
  return changed;
}

/// From a guess, until signs and inequalities are right.
CrossoverStatus Crossover::attempt(double factor, CrossoverReport& report) {
  guess_active(factor);
  for (int changes = 0; changes <= most_changes; ++changes, ++report.changes) {
    evaluate();
    const Outcome outcome = solve_for_active(report);
    if (outcome == Outcome::wrong_inertia) return CrossoverStatus::degenerate;
    if (outcome == Outcome::interrupted) return CrossoverStatus::interrupted;
    if (outcome == Outcome::diverged) return CrossoverStatus::not_improved;
    if (!change_active()) return CrossoverStatus::crossed;
  }
  return CrossoverStatus::degenerate;
}

CrossoverReport Crossover::cross(const StageRows& costates, const StageRows& multipliers) {
  CrossoverReport report;
  costates_ = costates;
  multipliers_ = multipliers;
  evaluate();
  report.before = kkt_residual(transcription_, values_, derivatives_, costates_, multipliers_, gradient_);
  for (std::size_t i = 0; i < active_.size(); ++i) slacks_.numbers()[i] = -values_.inequality.numbers()[i];
  report.status = attempt(1, report);
  if (report.status == CrossoverStatus::degenerate) {
    // Too many, as along an arc whose multipliers nearly vanish: from those that are sure, what is violated comes in.
    costates_ = costates;
    multipliers_ = multipliers;
    report.status = attempt(sure, report);
  }
  if (!report.crossed()) return report;
  evaluate();
  report.after = kkt_residual(transcription_, values_, derivatives_, costates_, multipliers_, gradient_);
  report.active = std::count(active_.begin(), active_.end(), true);
  for (long k = 0; k < sizes_.stages; ++k) report.cost += values_.cost[k][0];
  // From round-off to round-off, chance decides which is smaller.
  if (!(report.after.largest() < std::max(report.before.largest(), round_off)))
    report.status = CrossoverStatus::not_improved;
  return report;
}

}  // namespace lagroid
