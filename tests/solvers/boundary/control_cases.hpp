#pragma once
/// Control problems to start from, and the same in the unknowns of the Lie-Poisson equations.

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/attitude_control.hpp>
#include <lagroid/systems/control/unicycle.hpp>
#include <lagroid/systems/rotations/lie_poisson.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace lagroid {

using Vector3 = Vector<double, 3>;
using Matrix3 = Matrix<double, 3, 3>;

/// A system without symmetries, and a momentum to start from.
template <class Sys> struct Case;
template <> struct Case<Unicycle> {
  Unicycle system;
  Vector3 momentum{0.7, -0.9, 0.6};
  Case() { system.speed = 1.3; }
  static double casimir(const Vector3& mu) { return mu.tail<2>().norm(); }
};
template <> struct Case<AttitudeControl> {
  AttitudeControl system;
  Vector3 momentum{0.9, -0.4, 1.1};
  Case() {
    system.weights << 1, 1.7, 0.6;
    system.forbidden << 0.48, -0.6, 0.64;
  }
  static double casimir(const Vector3& mu) { return mu.norm(); }
};

template <class Sys> FixedStepIntegrator<Sys> walk(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return {system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>()};
}
template <class Sys> FixedStepIntegrator<Sys> walk(const Sys& system, const Vector3& momentum) {
  return walk(system, State<typename Sys::GroupoidType>{{}, momentum});
}
template <class Sys> std::vector<Step<Sys>> steps_of(const Sys& system, const Vector3& momentum, int count) {
  auto integrator = walk(system, momentum);
  std::vector<Step<Sys>> out;
  for (int k = 0; k < count; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    out.push_back(integrator.point().step);
  }
  return out;
}
/// How far the steps of a system are from the discrete Lie-Poisson equations, after 300 of them.
template <class Sys, class Other>
double lie_poisson_difference(const Sys& system, const Other& other, const Vector3& start) {
  auto integrator = walk(system, start);
  Vector3 mu = start;
  double difference = 0;
  for (int k = 0; k < 300; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    const auto& point = integrator.point();
    const auto next = lie_poisson_step(other, mu);
    EXPECT_TRUE(next.converged());
    mu = next.momentum;
    difference = std::max({difference, (mu - point.state.momentum).norm(),
                           (other.arrow(next.control.velocity) - point.step.arrow).norm()});
    if constexpr (Sys::constraints > 0)
      difference = std::max(difference, (next.control.multipliers - point.step.multipliers).norm());
  }
  return difference;
}

}  // namespace lagroid
