#pragma once
/// Moved to <lagroid/solvers/integrators/compensated_trajectory.hpp>; this goes with version 0.4.

#include <lagroid/solvers/integrators/compensated_trajectory.hpp>

namespace lagroid {

template <DiscreteSystem Sys> using Walk [[deprecated("Walk is CompensatedTrajectory")]] = CompensatedTrajectory<Sys>;

}  // namespace lagroid
