// From a saddle to what costs less. Newton's method shifts its matrix to that of a minimum, which leads away from
// saddles only where the gradient has a part that does: of a start with a symmetry it has none.
#include <lagroid/solvers/control/interior_point.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace lagroid {

namespace {

void scale(TrajectoryDisplacement& x, double by) {
  for (double& each : x.nodes.numbers()) each *= by;
  for (double& each : x.controls.numbers()) each *= by;
  for (double& each : x.durations) each *= by;
}

/// Numbers drawn at random, the same ones every time.
void draw(TrajectoryDisplacement& x) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (double& each : x.nodes.numbers()) each = normal(generator);
  for (double& each : x.controls.numbers()) each = normal(generator);
  for (double& each : x.durations) each = normal(generator);
}

}  // namespace

/// The curvature along that direction of the constraints' tangents, of length one and left in `step_`, of which it is
/// about the least: by inverse iteration, from the least shift, to a factor of two, that makes a minimum's matrix.
double InteriorPoint::least_curvature() {
  constexpr int most = 100;
  constexpr int iterations = 10;
  const auto is_convex = [&](double shift) {
    const StageKkt::Inertia inertia = kkt_.factor(shift, dual_);
    return inertia.smallest > 1e-18 && inertia.negative == kkt_.equalities();
  };
  double shift = 1e-12;
  for (int i = 0; !is_convex(shift); ++i) {
    if (i == most) return 0;
    shift *= 2;
  }
  set_all(right_.multipliers, 0);
  draw(right_.primal);
  double curvature = 0;
  for (int i = 0; i < iterations; ++i) {
    kkt_.solve(right_, step_);
    const double square = dot(step_.primal, step_.primal);
    curvature = dot(right_.primal, step_.primal) / square - shift;
    scale(step_.primal, 1 / std::sqrt(square));
    right_.primal = step_.primal;
  }
  return curvature;
}

/// Goes along `step_`, one way or the other, as far as the Lagrangian falls: at most half of the way to where an
/// inequality acts. False where it does not.
bool InteriorPoint::fall() {
  constexpr double farthest = 0.5;
  constexpr double nearest = 1e-6;
  const auto lagrangian = [&](const StageValues& at) {
    double sum = dot(costates_, at.equality) + dot(multipliers_, at.inequality);
    for (const double each : at.cost.numbers()) sum += each;
    return sum;
  };
  const double now = lagrangian(values_);
  set_all(gap_, 0);
  set_all(step_.multipliers, 0);
  scale(step_.primal, 1 / largest_entry(step_.primal));
  for (int way = 0; way < 2; ++way) {
    slack_directions(gap_);
    set_all(multiplier_step_, 0);
    for (double t = farthest * fraction_to_boundary(slacks_, slack_step_); t > nearest; t /= 2) {
      try_step(t);
      if (!(lagrangian(trial_) < now)) continue;
      take(t);
      return true;
    }
    negate(step_.primal);
  }
  return false;
}

ControlReport InteriorPoint::leave_saddle() {
  report_.status = ControlStatus::stagnated;
  const double curvature = least_curvature();
  if (curvature < 0 && fall()) {
    // A barrier that curves less than the cost does, or it would lead back.
    barrier_ = std::clamp(-0.01 * curvature, barrier_, std::max(barrier_, options_.resumed_barrier));
    filter_.clear();
    report_.status = ControlStatus::not_converged;
    iterate(options_.max_iterations);
  }
  judge();
  return report_;
}

}  // namespace lagroid
