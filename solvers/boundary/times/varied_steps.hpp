#pragma once
/// Boundary values with steps that vary, of either kind, by one name: the sizes free, or prescribed by the arrows.
///
///     const TimedSolution<Kepler> path = solve_varied_steps(TimeMode::adaptive, kepler, boundary, equal);
///
/// `equal` is a solution with equal steps (with_times of timed_path.hpp). Requires TimeMode::adaptive, or
/// TimeMode::prescribed of a system with a time scale of its arrows. Returns what solve_free_steps and
/// solve_prescribed_steps do. Nothing throws.

#include <lagroid/solvers/boundary/times/free_steps.hpp>
#include <lagroid/solvers/boundary/times/prescribed_steps.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>

/// It is compiled once for each system of the library: a file that uses it for one says so.
#define LAGROID_VARIED_STEPS(prefix, Sys)                                                                        \
  prefix TimedSolution<Sys> solve_varied_steps(TimeMode, const Sys&, const ArrowOf<typename Sys::GroupoidType>&, \
                                               const TimedSolution<Sys>&)

namespace lagroid {

/// The path with steps of that mode beside one of equal steps.
template <Timed Sys>
TimedSolution<Sys> solve_varied_steps(TimeMode mode, const Sys& system,
                                      const ArrowOf<typename Sys::GroupoidType>& boundary,
                                      const TimedSolution<Sys>& equal) {
  if constexpr (HasTimeScaleOfArrows<Sys>)
    if (mode == TimeMode::prescribed) return solve_prescribed_steps(system, boundary, equal);
  return solve_free_steps(system, boundary, equal);
}

}  // namespace lagroid
