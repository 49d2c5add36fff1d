#pragma once
/// The plate-ball boundary-value problem, from guesses to minima: the cheapest way to roll a ball from one place and
/// attitude to another in a given time.
///
///     PlateBall system;
///     system.h = 5.0 / 100;
///     const auto found = solve_plate_ball(*make_boundary_solver<PlateBall>(), system,
///                                         {{{0, 0}, {1, 1}}, SO3::exp(Vector<double, 3>(0, 0, 1))}, {.steps = 100});
///
/// Requires h = horizon / steps. Throws std::invalid_argument where `unreachable` has a reason or the boundary is not
/// finite. Returns the minima found, cheapest first.

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include <cstdint>
#include <functional>

namespace lagroid {

struct PlateBallBoundaryOptions {
  long steps = 0;                                ///< N, at least 3
  int starts = 40;                               ///< the straight line, then straight lines wound and bent
  std::uint64_t seed = 1;                        ///< of what is drawn
  std::function<void(int)> report = [](int) {};  ///< called with the number of starts done
  int threads = 0;                               ///< solves at a time; 0: as many as there are processors
};

/// Why no trajectory of N arrows can exist, or nothing (decidable cases only).
std::optional<std::string> unreachable(const PlateBall& system, long steps);

/// Minima of the cost between the ends of `boundary`: multistart in the exp form with at most 20 arrows, then
/// continuation in the number of arrows and in the form of the rotation. `system.h` must be horizon / steps.
/// Throws std::invalid_argument where `unreachable` has a reason or the boundary is not finite.
MultistartResult<PlateBall> solve_plate_ball(const BoundarySolver<PlateBall>& solver, const PlateBall& system,
                                             const ArrowOf<PlateBall::GroupoidType>& boundary,
                                             const PlateBallBoundaryOptions& options);

}  // namespace lagroid
