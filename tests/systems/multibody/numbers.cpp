// Scenes of bodies: the same numbers as the systems written by hand and as formulas.
#include "machine.hpp"

#include "../../support/integrating.hpp"

#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::multibody_tests::numbers_tests {
namespace {

TEST(MultibodyNumbers, SphericalPendulum) {
  SphericalPendulum system;
  system.bob_mass = 1.3;
  system.length = 0.7;
  system.gravity = 9.81;
  system.h = 0.01;
  const Vec q = system.length * Vec(0.6, 0.1, -0.8).normalized();
  const Vec v = Vec(0.3, 1.1, 0).cross(q);
  const auto end = integrate(system, {q, system.bob_mass * v}, 500);

  Scene scene;
  const Body bob = scene.point_mass(1.3, q, v);
  scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 0.7});
  scene.add(ConstantForce{{bob.centre}, {0, 0, -1.3 * 9.81}});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 500);
  EXPECT_LT((motion.configuration()(motion(bob.centre)) - end.state.object).norm(), 1e-12);
  EXPECT_LT((motion.momenta().linear[0] - tangent_momentum(system, end.state)).norm(), 1e-11);
  EXPECT_LT(motion.constraint_residual(), 1e-15);
}

TEST(MultibodyNumbers, Kepler) {
  Kepler system;
  system.h = 0.01;
  system.quadrature = Quadrature::trapezoid;
  const auto end = integrate(system, {{0.4, 0}, {0, 2}}, 1000);
  Scene scene;
  const Body planet = scene.point_mass(1, {0.4, 0, 0}, {0, 2, 0});
  scene.add(CentralGravity{{planet.centre}, Vec::Zero(), 1});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 1000);
  EXPECT_LT((motion.configuration()(motion(planet.centre)).head<2>() - end.state.object).norm(), 1e-10);
}

TEST(MultibodyNumbers, RigidBody) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    RigidBody system;
    system.h = 0.05;
    system.rotation = map;
    const Vec m(0.4, 1.7, -0.9);
    const auto end = integrate(system, {{}, m}, 1000);
    Scene scene;
    scene.rotation = map;
    const Body body = scene.pivoted_body(system.inertia, Vec::Zero(), upright, m.cwiseQuotient(system.inertia));
    Multibody motion(std::move(scene), 0.05);
    advance(motion, 1000);
    EXPECT_LT((motion.momenta().spin[0] - end.state.momentum).norm(), 2e-12);
    EXPECT_LT((motion.configuration()(motion(body.attitude)) - end.configuration).norm(), 2e-12);
    EXPECT_LT((motion.angular_momentum(motion.momenta()) - m).norm(), 1e-13);
  }
}

TEST(MultibodyNumbers, HeavyTop) {
  HeavyTop system;
  system.h = 0.01;
  system.inertia = {1.1, 0.9, 0.5};
  system.weight = {0.1, 0.2, 1.4};
  const Vec m(0.2, 0.1, 2.5);
  const auto end = integrate(system, {Vec(0, 0, 1), m}, 500);
  Scene scene;
  const Body top = scene.pivoted_body(system.inertia, Vec::Zero(), upright, m.cwiseQuotient(system.inertia));
  scene.add(ConstantForce{{scene.point_of(top, system.weight / 3.0)}, {0, 0, -3}});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 500);
  EXPECT_LT((motion.momenta().spin[0] - end.state.momentum).norm(), 1e-11);
}

TEST(MultibodyNumbers, RollingBall) {
  RollingBall system;
  system.radius = 0.3;
  system.plate_rate = 1.3;
  system.h = 0.02;
  const auto start = system.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7);
  const auto end = integrate(system, start, 500);
  Scene scene;
  const double inertia = system.inertia();
  const Body ball = scene.rigid_body(
      1, {inertia, inertia, inertia}, {0.3, -0.2, 0.3}, Quaternion(1, 0.2, 0.3, 0.4).normalized(), {0.4, 0.1, 0},
      SO3::from_quaternion(Quaternion(1, 0.2, 0.3, 0.4).normalized()).transpose() * system.angular_velocity(start));
  scene.add(Rolling{{ball.centre}, {ball.attitude}, 0.3, 1.3});
  scene.add(InPlane{{scene.ground({0, 0, 0.3}), ball.centre}, {Attitude{}}, {0, 0, 1}});
  scene.add(ConstantForce{{ball.centre}, {0, 0, -9.81}});
  Multibody motion(std::move(scene), 0.02);
  advance(motion, 500);
  const auto at = motion.configuration()(motion(ball.centre));
  EXPECT_LT((at.head<2>() - std::get<0>(end.state.object)).norm(), 1e-11);
  EXPECT_NEAR(at(2), 0.3, 1e-14);
  EXPECT_LT(motion.constraint_residual(), 1e-14);
}

/// Round a field line: the velocity turns by 2 atan(w h / 2) a step and keeps its size to round-off.
TEST(Multibody, ChargesGoRoundFieldLines) {
  Scene scene;
  const Body a = scene.point_mass(2, Vec::Zero(), {1, 0, 0.3});
  scene.gyroscopic_force(a, {0, 0, 1.5});
  Multibody motion(std::move(scene), 0.1);
  advance(motion, 1000);
  const Vec p = motion.momenta().linear[0];
  const double turned = -1000 * 2 * std::atan(0.75 * 0.1 / 2);
  EXPECT_LT((p - 2 * Vec(std::cos(turned), std::sin(turned), 0.3)).norm(), 1e-11);
  EXPECT_NEAR(p.norm(), 2 * std::sqrt(1.09), 1e-13);
}

/// A pendulum in a frame that turns is the same pendulum, seen from there.
TEST(Multibody, ATurningFrameShowsTheSamePendulum) {
  constexpr double rate = 0.4;
  constexpr double end = 3;
  const auto error = [&](int steps) {
    const auto run = [&](bool turning) {
      Scene scene;
      const Vec at = Vec(0.6, 0, -0.8);
      const Vec frame = rate * Vec::UnitZ();
      const Vec velocity = Vec(0.1, 0.7, 0.075);
      const Body bob = scene.point_mass(1, at, turning ? Vec(velocity - frame.cross(at)) : velocity);
      scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1});
      scene.add(ConstantForce{{bob.centre}, {0, 0, -9.81}});
      if (turning) {
        scene.gyroscopic_force(bob, 2 * frame);
        scene.add(Centrifugal{{bob.centre}, 1, frame});
      }
      Multibody motion(std::move(scene), end / steps);
      advance(motion, steps);
      return motion.configuration().x[0];
    };
    return (SO3::exp(Vec(0, 0, rate * end)) * run(true) - run(false)).norm();
  };
  const double coarse = error(300);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(std::log2(coarse / error(600)), 2, 0.1);
}

/// A ball that turns at a prescribed rate about the vertical keeps it.
TEST(Multibody, APrescribedSpinIsKept) {
  Scene scene;
  const Body body = scene.rigid_body(1, {0.2, 0.3, 0.4}, Vec::Zero(), upright, Vec::Zero(), {0, 0, 0.7});
  scene.add(PrescribedSpin{{}, {body.attitude}, {0, 0, 1}, 0.7});
  scene.add(ConstantForce{{scene.point_of(body, {0.5, 0, 0})}, {0, 0, 1}});
  Multibody motion(std::move(scene), 0.01);
  Mat before = motion.configuration()(motion(body.attitude));
  for (int k = 0; k < 200; ++k) {
    advance(motion, 1);
    const Mat now = motion.configuration()(motion(body.attitude));
    EXPECT_NEAR(SO3::log(Mat(now * before.transpose()))(2), 0.007, 1e-14);
    before = now;
  }
}

}  // namespace
}  // namespace lagroid::multibody_tests::numbers_tests
