#pragma once
/// Trajectories from a state, and the order at which their ends converge.

#include <lagroid/solvers/integrator.hpp>
#include <lagroid/solvers/newton_step.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace lagroid {

/// From `start`, with the unit arrow as configuration.
template <class Sys>
Integrator<Sys> integrator_from(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return Integrator<Sys>(system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>());
}

/// The point after `steps` steps, its momentum raw.
template <class Sys>
TrajectoryPoint<Sys> march(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  auto integrator = integrator_from(system, start);
  for (long k = 0; k < steps; ++k)
    if (!integrator.advance().converged()) {
      ADD_FAILURE() << "step " << k;
      break;
    }
  return integrator.point();
}

/// The slope of `error(system, end point)` over three halvings of the step from horizon / coarse, measured at the last
/// two; zero where there is no error to speak of.
template <class Sys, class Error>
double measured_order(Sys system, const State<typename Sys::GroupoidType>& start, double horizon, long coarse,
                      const Error& error) {
  std::vector<double> errors;
  for (const long steps : {coarse, 2 * coarse, 4 * coarse}) {
    system.h = horizon / double(steps);
    errors.push_back(error(system, march(system, start, steps)));
  }
  return errors[2] < 1e-12 ? 0 : std::log2(errors[1] / errors[2]);
}

/// The point's momentum as it is reported.
template <class Sys>
AlgebroidVector<typename Sys::GroupoidType> reported_momentum(const Sys& system, const TrajectoryPoint<Sys>& point) {
  return tangent_momentum(system, point.state);
}

}  // namespace lagroid
