#pragma once
/// How much of a step is tried: a free duration changes by a factor of e at most. What a Newton step says of it from
/// afar, where time costs something and the motion is not yet one, is to go to nothing, from where nothing leads back.
///
///     const double most = detail::fraction_of_durations(step);
///
/// A detail of InteriorPoint. Nothing throws.

#include <lagroid/solvers/control/transcription.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::detail {

/// Of a displacement, along the logarithms of the durations; one at most.
inline double fraction_of_durations(const TrajectoryDisplacement& step) {
  double largest = 1;
  for (const double change : step.durations) largest = std::max(largest, std::abs(change));
  return 1 / largest;
}

}  // namespace lagroid::detail
