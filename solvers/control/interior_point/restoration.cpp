#include <lagroid/solvers/control/interior_point.hpp>
#include <lagroid/solvers/control/interior_point/step_limit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

namespace {

/// The minimum of p + n - nu (log p + log n) over p - n = r, p, n > 0: a smooth |r|.
struct TwoSidedElastic {
  double p;
  double n;
  double slope;  ///< d/dr = 1 - nu / p = nu / n - 1
  TwoSidedElastic(double r, double nu) {
    const double root = std::hypot(r, nu);
    slope = r / (nu + root);
    // 1 - |slope| without cancellation.
    const double rest = (nu + nu * nu / (root + std::abs(r))) / (nu + root);
    const double larger = nu / rest;
    const double smaller = nu / (1 + std::abs(slope));
    p = r >= 0 ? larger : smaller;
    n = r >= 0 ? smaller : larger;
  }
  double value(double nu) const { return p + n - nu * (std::log(p) + std::log(n)); }
};

/// The minimum of e - nu (log e + log s) over e - s = gamma, e, s > 0: a smooth positive part.
struct OneSidedElastic {
  double e;
  double s;
  double slope;  ///< d/dgamma = nu / s = 1 - nu / e
  OneSidedElastic(double gamma, double nu) {
    const double root = std::hypot(gamma, 2 * nu);
    e = gamma >= 0 ? 0.5 * (gamma + 2 * nu + root) : -2 * nu * gamma / (root - gamma - 2 * nu);
    s = gamma <= 0 ? 0.5 * (2 * nu - gamma + root) : 2 * nu * gamma / (root + gamma - 2 * nu);
    slope = nu / s;
  }
  double value(double nu) const { return e - nu * (std::log(e) + std::log(s)); }
};

/// So many iterations that lower the smoothed violation by no more than this part of the violation are enough of one
/// smoothing: what they converge to linearly is not worth them.
constexpr int patience = 10;
constexpr double worth = 1e-2;
/// The least smoothing, of the largest violation: what is stationary then is so of the violation itself.
constexpr double least_smoothing = 1e-5;

}  // namespace

double InteriorPoint::smoothed_violation(const StageValues& at, double nu) const {
  double sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.equalities_of(k); ++i) sum += TwoSidedElastic(at.equality[k][i], nu).value(nu);
    for (int i = 0; i < sizes_.inequality; ++i) sum += OneSidedElastic(at.inequality[k][i], nu).value(nu);
  }
  return sum;
}

/// Lowers the sum of |phi| and of gamma's positive part, smoothed by logarithms of elastic variables,
///
///     |r| ~ min p + n - nu (log p + log n) over p - n = r,    gamma^+ ~ min e - nu (log e + log s) over e - s = gamma,
///
/// by a primal-dual Newton iteration until the filter takes the trajectory. The elastic variables are always those
/// that are best, so that the line search is one of a single smooth function. False where it ends at a stationary
/// point of the violation.
bool InteriorPoint::restore() {
  ++report_.restorations;
  const double start = merit(values_, slacks_).violation;
  double smoothing = std::max(barrier_, largest_violation(sizes_, values_, rounding_));
  set_all(costates_, 0);
  set_all(multipliers_, 0.5);
  last_shift_ = 0;
  bool found = false;
  int age = 0;  // iterations with this smoothing
  double before = 0;
  // False where that was the least.
  const auto smooth_less = [&] {
    if (smoothing <= std::max(1e-7, least_smoothing * largest_violation(sizes_, values_, rounding_))) return false;
    smoothing *= 0.1;
    age = 0;
    return true;
  };
  while (report_.iterations < most_iterations_ && goes_on()) {
    ++report_.iterations;
    evaluate();
    for (long k = 0; k < sizes_.stages; ++k) {
      for (int i = 0; i < sizes_.equalities_of(k); ++i) {
        const TwoSidedElastic e(values_.equality[k][i], smoothing);
        const double zp = 1 - costates_[k][i];
        const double zn = 1 + costates_[k][i];
        dual_[k][i] = e.p / zp + e.n / zn;
        right_.multipliers[k][i] = (smoothing / zp - e.p) - (smoothing / zn - e.n);
        equality_[k][i] = e.slope;
      }
      for (int i = 0; i < sizes_.inequality; ++i) {
        const OneSidedElastic e(values_.inequality[k][i], smoothing);
        const double y = multipliers_[k][i];
        sigma_[k][i] = 1 / (e.s / y + e.e / (1 - y));
        gap_[k][i] = (smoothing / y - e.s) - (smoothing / (1 - y) - e.e);
        weights_[k][i] = e.slope;
      }
    }
    kkt_.assemble(derivatives_, sigma_);
    set_all(derivatives_.gradient, 0);
    lagrangian_gradient(transcription_, derivatives_, equality_, weights_, gradient_);
    const double steepest = largest_entry(gradient_);
    const double now = smoothed_violation(values_, smoothing);
    const bool is_slow = age > 0 && age % patience == 0 && before - now <= worth * merit(values_, slacks_).violation;
    if (is_slow || steepest <= std::clamp(smoothing, 1e-6, 1e-2)) {
      if (!smooth_less()) break;
      continue;
    }
    if (age++ % patience == 0) before = now;
    lagrangian_gradient(transcription_, derivatives_, costates_, weights_, right_.primal);
    negate(right_.primal);
    if (!factor(right_)) break;
    kkt_.solve_eliminated(right_, step_);

    const double slope = dot(gradient_, step_.primal);
    double fraction = detail::fraction_of_durations(step_.primal);
    bool lower = false;
    for (; fraction > 1e-12 && !lower; fraction *= lower ? 1 : 0.5) {
      transcription_.try_displacement(step_.primal, fraction);
      transcription_.values(trial_);
      lower = smoothed_violation(trial_, smoothing) <=
              now + 1e-4 * fraction * slope + 10 * std::numeric_limits<double>::epsilon() * std::abs(now);
    }
    if (!lower) {
      if (!smooth_less()) break;
      continue;
    }
    // Multipliers stay within their bounds, |lambda| < 1 and 0 < z < 1.
    double of_multipliers = 1;
    const auto keep_within = [&](double at, double along, double least, double most) {
      if (along < 0) of_multipliers = std::min(of_multipliers, 0.99 * (at - least) / -along);
      if (along > 0) of_multipliers = std::min(of_multipliers, 0.99 * (most - at) / along);
    };
    for (long k = 0; k < sizes_.stages; ++k) {
      for (int i = 0; i < sizes_.equalities_of(k); ++i) keep_within(costates_[k][i], step_.multipliers[k][i], -1, 1);
      for (int i = 0; i < sizes_.inequality; ++i) {
        multiplier_step_[k][i] = sigma_[k][i] * (change_of_inequality(k, i) + gap_[k][i]);
        keep_within(multipliers_[k][i], multiplier_step_[k][i], 0, 1);
      }
    }
    add(costates_, of_multipliers, step_.multipliers);
    add(multipliers_, of_multipliers, multiplier_step_);
    transcription_.accept();
    std::swap(values_, trial_);
    for (long k = 0; k < sizes_.stages; ++k)
      for (int i = 0; i < sizes_.inequality; ++i)
        slacks_[k][i] = std::max(-values_.inequality[k][i], std::min(1e-4, std::max(barrier_, 1e-8)));
    const Merit there = merit(values_, slacks_);
    if (there.violation <= 0.9 * start && accepted_by_filter(there)) {
      found = true;
      break;
    }
  }
  for (std::size_t i = 0; i < multipliers_.numbers().size(); ++i)
    multipliers_.numbers()[i] = std::min(1e3, barrier_ / slacks_.numbers()[i]);
  least_squares_costates();
  return found || largest_violation(sizes_, values_, rounding_) <= options_.tolerance;
}

}  // namespace lagroid
