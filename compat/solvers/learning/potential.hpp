#pragma once
/// Moved to <lagroid/solvers/learning/potentials/potential.hpp>; this goes with version 0.4.

#include <lagroid/solvers/learning/potentials/potential.hpp>

namespace lagroid::learning {

enum class TrainingStatus;
using Outcome [[deprecated("Outcome is TrainingStatus")]] = TrainingStatus;
template <class S, int K> using Places [[deprecated("Places are Positions")]] = Positions<S, K>;

}  // namespace lagroid::learning
