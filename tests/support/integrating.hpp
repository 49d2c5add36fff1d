#pragma once
/// Trajectories from a state, and the order at which their ends converge.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace lagroid {

/// From `start`, with the unit arrow as configuration.
template <class Sys>
FixedStepIntegrator<Sys> integrator_from(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return FixedStepIntegrator<Sys>(system, start, system.groupoid.unit(start.object),
                                  std::make_unique<NewtonStep<Sys>>());
}

/// The point after `steps` steps, its momentum raw.
template <class Sys>
TrajectoryPoint<Sys> integrate(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  auto integrator = integrator_from(system, start);
  for (long k = 0; k < steps; ++k)
    if (!integrator.advance().converged()) {
      ADD_FAILURE() << "step " << k;
      break;
    }
  return integrator.point();
}

/// laws::measured_order of `error(system, end point)` after `horizon`, from `coarse` steps on.
template <class Sys, class Error>
double measured_order(Sys system, const State<typename Sys::GroupoidType>& start, double horizon, int coarse,
                      const Error& error) {
  return laws::measured_order(
      [&](int steps) {
        system.h = horizon / steps;
        return error(system, integrate(system, start, steps));
      },
      coarse);
}

/// The point's momentum as it is reported.
template <class Sys>
AlgebroidVector<typename Sys::GroupoidType> reported_momentum(const Sys& system, const TrajectoryPoint<Sys>& point) {
  return tangent_momentum(system, point.state);
}

}  // namespace lagroid
