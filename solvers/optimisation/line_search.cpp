#include <lagroid/solvers/optimisation/line_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::optimisation {

namespace {

/// What values near the minimum differ by for rounding alone.
double rounding_of(const EvaluatedPoint& state) {
  return 64 * std::numeric_limits<double>::epsilon() * std::abs(state.value);
}

/// The slope at `to` of the curve that left `from` along the direction: in the metric of the space around the direction
/// itself stands for the curve's there.
double slope_at(const Manifold& manifold, const Point& from, const EvaluatedPoint& to, const Vector& direction,
                Vector& buffer) {
  if (!manifold.has_own_metric()) return to.gradient.dot(direction);
  buffer = direction;
  manifold.transport(from, to.x, buffer);
  return manifold.inner(to.x, to.gradient, buffer);
}

}  // namespace

double backtrack(Problem& problem, ManifoldRetraction retraction, const EvaluatedPoint& state, const Vector& direction,
                 double slope, double first, double decrease, Point& to, Vector& buffer) {
  constexpr int most = 60;
  const double rounding = rounding_of(state);
  double t = first;
  for (int k = 0; k < most; ++k) {
    buffer = t * direction;
    double next = 0.5 * t;
    if (problem.manifold().retract(retraction, state.x, buffer, to)) {
      const double value = problem.value(to);
      if (value <= state.value + decrease * t * slope + rounding) return t;
      const double lowest = -slope * t * t / (2 * (value - state.value - slope * t));
      if (std::isfinite(lowest)) next = std::clamp(lowest, 0.1 * t, 0.5 * t);
    }
    t = next;
  }
  return 0;
}

double secant_search(Problem& problem, ManifoldRetraction retraction, const EvaluatedPoint& state,
                     const Vector& direction, double slope, double first, double flat, EvaluatedPoint& to,
                     Vector& buffer) {
  constexpr int most = 40;
  constexpr int patience = 8;  // then a point that falls is enough
  constexpr double decrease = 1e-4;
  constexpr double furthest = 8;  // times the last, where the slope still falls
  const double rounding = rounding_of(state);
  double low = 0;
  double low_slope = slope;
  double high = std::numeric_limits<double>::infinity();
  double best = 0;
  double best_value = std::numeric_limits<double>::infinity();
  double t = first;
  const auto evaluate = [&](double at) {
    buffer = at * direction;
    if (!problem.manifold().retract(retraction, state.x, buffer, to.x)) return false;
    problem.evaluate(to);
    return true;
  };
  for (int k = 0; k < most && t > 0 && std::isfinite(t) && !(k >= patience && best > 0); ++k) {
    bool falls = evaluate(t);
    double there = std::numeric_limits<double>::quiet_NaN();
    if (falls) {
      there = slope_at(problem.manifold(), state.x, to, direction, buffer);
      falls = to.value <= state.value + decrease * t * slope + rounding;
    }
    if (falls && std::abs(there) <= flat * std::abs(slope)) return t;
    if (falls && to.value < best_value) {
      best = t;
      best_value = to.value;
    }
    const double secant = low + (t - low) * low_slope / (low_slope - there);
    if (falls && there < 0) {
      const double ahead = there > low_slope ? secant : furthest * t;
      low = t;
      low_slope = there;
      t = std::isfinite(high) ? std::clamp(ahead, low + 0.1 * (high - low), low + 0.9 * (high - low))
                              : std::min(ahead, furthest * t);
    } else {
      high = t;
      t = there > 0 ? std::clamp(secant, low + 0.1 * (high - low), low + 0.9 * (high - low)) : low + 0.3 * (high - low);
    }
  }
  return best > 0 && evaluate(best) ? best : 0;
}

}  // namespace lagroid::optimisation
