#pragma once
/// Boundary-value problems whose answers are known: the ends of trajectories of the integrator; and the plate-ball's.

#include <lagroid/solvers/boundary/boundary_problem.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace lagroid {

/// A problem whose answer is known: the ends of a trajectory of the integrator.
template <class Sys> struct Known {
  BoundaryProblem<Sys> problem;
  State<typename Sys::GroupoidType> start;
  Path<Sys> path;
};

template <class Sys>
Known<Sys> known(const Sys& system, const State<typename Sys::GroupoidType>& start, std::size_t steps) {
  const auto unit = system.groupoid.unit(start.object);
  FixedStepIntegrator<Sys> integrator(system, start, unit, std::make_unique<NewtonStep<Sys>>());
  Known<Sys> out{{system, unit}, start, {}};
  for (std::size_t k = 0; k < steps; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    out.path.push_back(integrator.point().step);
  }
  out.problem.boundary = integrator.point().configuration;
  return out;
}

inline Pendulum pendulum() {
  Pendulum system;
  system.h = 0.05;
  return system;
}
inline Kepler kepler() {
  Kepler system;
  system.h = 0.02;
  return system;
}
inline RigidBody rigid_body() {
  RigidBody system;
  system.h = 0.04;
  return system;
}
inline SphericalPendulum spherical_pendulum() {
  SphericalPendulum system;
  system.h = 0.03;
  return system;
}

inline PlateBall plate_ball(std::size_t steps) {
  PlateBall system;
  system.h = 1 / double(steps);
  system.rotation = RotationForm::exponential;
  system.plate_rate = 1;
  system.spin = 0.5;
  return system;
}
inline ArrowOf<PlateBall::GroupoidType> plate_ball_ends() {
  return {PairArrow<double, 2>{{0.2, -0.1}, {1, 0.5}}, SO3::exp(Vector<double, 3>(0.6, -0.3, 0.9))};
}
inline Path<PlateBall> straight(const PlateBall& system, std::size_t steps) {
  Path<PlateBall> path;
  for (const auto& arrow : system.path(plate_ball_ends(), long(steps), Eigen::Matrix2Xd::Zero(2, 1)))
    path.push_back({arrow, PlateBall::Multipliers::Zero()});
  return path;
}

}  // namespace lagroid
