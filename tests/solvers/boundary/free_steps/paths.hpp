#pragma once
/// Paths of equal and of free steps between two ends, and the energies of their arrows.

#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/boundary/times/free_steps.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lagroid {

/// The best path of equal steps.
template <class Sys>
TimedSolution<Sys> equal_steps(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                               std::size_t steps) {
  const auto stage = equal_steps_stage(system, boundary, steps);
  const auto found = solve_boundary(*make_boundary_solver<Sys>(), stage.problem, steps, {.starts = 4});
  EXPECT_FALSE(found.solutions.empty());
  return with_times<Sys>(stage, found.solutions.front());
}
template <class Sys>
TimedSolution<Sys> free_steps(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary,
                              std::size_t steps) {
  return solve_free_steps(system, boundary, equal_steps(system, boundary, steps));
}

/// The largest difference of E_d between arrows, and its largest size.
template <class Sys> std::array<double, 2> energy_spread(const Sys& system, const TimedSolution<Sys>& path) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t k = 0; k < path.path.size(); ++k) {
    const double energy = discrete_energy(system, path.path[k], path.times[k], path.times[k + 1] - path.times[k]);
    least = std::min(least, energy);
    most = std::max(most, energy);
  }
  return {most - least, std::max(std::abs(least), std::abs(most))};
}
template <class Sys> void expect_one_energy(const Sys& system, const TimedSolution<Sys>& path) {
  ASSERT_TRUE(path.converged()) << to_string(path.status) << " " << path.message;
  const auto [spread, size] = energy_spread(system, path);
  EXPECT_LE(spread, 1e-12 * size);
  EXPECT_NEAR(path.energy, discrete_energy(system, path.path[0], path.times[0], path.times[1] - path.times[0]),
              1e-12 * size);
}

}  // namespace lagroid
