#pragma once
/// The order of a method, measured.

#include <cmath>
#include <limits>

namespace lagroid {

/// The slope of error(steps), the error after a fixed time by that many steps, as the steps shrink: from the slopes
/// between three numbers of steps, 3 / 2 apart, the last ones that leave the error above the plateau of round-off. The
/// error of a symmetric method is h^p (c_0 + c_1 h^2 + ...), so that slopes approach p like h^2, and are extrapolated.
/// NaN where fewer than three errors are above the plateau.
template <class Error> double measured_order(const Error& error, int steps, double plateau = 1e-11) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double last = error(steps);
  double slope = nan;
  double order = nan;
  while (steps < 3000) {
    const int more = steps + steps / 2;
    const double ratio = double(more) / steps;
    const double next = error(more);
    if (!(next >= plateau)) break;
    const double next_slope = std::log(last / next) / std::log(ratio);
    order = next_slope - (slope - next_slope) / (ratio * ratio - 1);
    slope = next_slope;
    steps = more;
    last = next;
  }
  return order;
}

}  // namespace lagroid
