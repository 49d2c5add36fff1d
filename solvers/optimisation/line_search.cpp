#include <lagroid/solvers/optimisation/line_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::optimisation {

double backtrack(Problem& problem, Retraction retraction, const State& state, const Vector& direction, double slope,
                 double first, double decrease, Point& to, Vector& buffer) {
  constexpr int most = 60;
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(state.value);
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

}  // namespace lagroid::optimisation
