// Scenes of bodies: the same numbers as the systems written by hand, order, reversibility, momenta, joints.

#include "../support/allocation_counter.hpp"
#include "../support/integrating.hpp"

#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace lagroid {
namespace {

using namespace multibody;
using multibody::Vec;

const Quaternion upright{1, 0, 0, 0};

void advance(Multibody& scene, long steps) {
  for (long k = 0; k < steps; ++k) {
    const StepReport report = scene.advance();
    ASSERT_TRUE(report.converged()) << to_string(report.status) << " at step " << k << ", roundoff_ratio "
                                    << report.roundoff_ratio;
  }
}

double energy(const Multibody& scene) { return scene.kinetic_energy(scene.momenta()) + scene.potential_energy(); }

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

/// A box that hangs by a ball joint from a sliding, turning carriage; a spring and a bob on a rod.
struct Machine {
  Body carriage, box, bob;
  Scene scene;

  explicit Machine(double damping = 0) {
    const Vec inertia(0.3, 0.4, 0.5);
    carriage = scene.rigid_body(2, inertia, {0, 0, 0}, upright, {0.1, 0, 0}, {0, 0, 0});
    box = scene.rigid_body(1, {0.1, 0.05, 0.12}, {0.5, 0.2, -0.7}, Quaternion(1, 0.2, -0.1, 0.3).normalized(),
                           {0.1, 0, 0}, {0, 0, 0});
    bob = scene.point_mass(0.4, {0.5, 0.2, -1.5}, {0.1, 0.3, 0});
    const Site under = scene.point_of(carriage, {0.5, 0.2, -0.3});
    const auto attitude = SO3::from_quaternion(Quaternion(1, 0.2, -0.1, 0.3).normalized());
    scene.add(Coincidence{{under, scene.point_of(box, attitude.transpose() * Vec(0, 0, 0.4))}});
    scene.add(Rod{{box.centre, bob.centre}, 0.8});
    // The carriage slides along the first axis and turns about it.
    const Site rail = scene.ground(Vec::Zero());
    scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 1, 0}});
    scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 0, 1}});
    scene.add(FixedAngle{{}, {Attitude{}, carriage.attitude}, {0, 1, 0}, {1, 0, 0}});
    scene.add(FixedAngle{{}, {Attitude{}, carriage.attitude}, {0, 0, 1}, {1, 0, 0}});
    for (const auto& [body, mass] : {std::pair{carriage, 2.0}, {box, 1.0}, {bob, 0.4}})
      scene.add(ConstantForce{{body.centre}, {0, 0, -9.81 * mass}});
    scene.add(Spring{{scene.ground({1, 0, 0}), scene.point_of(box, {0.1, 0.1, 0})}, 5, 0.4});
    if (damping > 0) scene.damp(box, damping, damping);
  }
};

TEST(Multibody, EnergyOfAMachineIsBounded) {
  Machine machine;
  Multibody motion(std::move(machine.scene), 0.005);
  EXPECT_EQ(motion.islands(), 1);
  EXPECT_EQ(motion.dependent_rows(), 0);
  EXPECT_LT(motion.velocity_defect(), 1e-12);
  const double first = energy(motion);
  double early = 0;
  double late = 0;
  for (int k = 0; k < 8; ++k) {
    double& worst = k < 4 ? early : late;
    for (int j = 0; j < 50; ++j) {
      advance(motion, 50);
      worst = std::max(worst, std::abs(energy(motion) - first));
    }
  }
  EXPECT_LT(early, 1e-2);
  EXPECT_LT(late, 2 * early);
  EXPECT_LT(motion.constraint_residual(), 1e-14);
}

TEST(Multibody, GoesBackTheWayItCame) {
  Machine machine;
  Multibody motion(std::move(machine.scene), 0.01);
  const auto start = motion.state();
  advance(motion, 100);
  motion.reverse();
  advance(motion, 100);
  const auto end = motion.state();
  for (std::size_t f = 0; f < start.momentum.size(); ++f) {
    EXPECT_LT((start.at.x[f] - end.at.x[f]).norm(), 1e-10);
    EXPECT_LT((start.momentum[f] + motion.momenta().linear[f]).norm(), 1e-8);
  }
}

TEST(Multibody, IsOfOrderTwo) {
  const auto end = [](int steps, double damping) {
    Machine machine(damping);
    Multibody motion(std::move(machine.scene), 0.5 / steps);
    advance(motion, steps);
    Vector<double, 12> out;
    const auto m = motion.momenta();
    out << motion.configuration()(motion(machine.bob.centre)), m.linear[1], m.spin[0], m.spin[1];
    return out;
  };
  for (const double damping : {0.0, 0.7}) {
    const auto fine = end(3200, damping);
    const double coarse_error = (end(50, damping) - fine).norm();
    const double finer_error = (end(100, damping) - fine).norm();
    EXPECT_NEAR(std::log2(coarse_error / finer_error), 2.0, 0.1) << damping;
  }
}

multibody::Options composed(const Composition& composition) {
  multibody::Options options;
  options.composition = composition;
  return options;
}

TEST(Multibody, ComposedStepsHaveTheirOrders) {
  for (const auto& composition : compositions::all) {
    const auto end = [&](int steps) {
      Machine machine;
      Multibody motion(std::move(machine.scene), 0.5 / steps, composed(composition));
      advance(motion, steps);
      EXPECT_DOUBLE_EQ(motion.time(), 0.5);
      EXPECT_EQ(motion.index(), steps);
      Eigen::VectorXd out(12);
      const auto m = motion.momenta();
      out << motion.configuration()(motion(machine.bob.centre)), m.linear[1], m.spin[0], m.spin[1];
      return out;
    };
    static const Eigen::VectorXd exact = [] {
      Machine machine;
      Multibody motion(std::move(machine.scene), 0.5 / 400, composed(compositions::kahan_li_8));
      advance(motion, 400);
      Eigen::VectorXd out(12);
      const auto m = motion.momenta();
      out << motion.configuration()(motion(machine.bob.centre)), m.linear[1], m.spin[0], m.spin[1];
      return out;
    }();
    const int coarse = composition.order == 2 ? 50 : composition.order == 8 ? 3 : 12;
    EXPECT_NEAR(laws::measured_order({end, exact, coarse, 1e-11}), composition.order, 0.4) << composition.name;
  }
}

TEST(Multibody, ComposedStepsFollowAMovedSupport) {
  const auto end = [](int steps, const Composition& composition) {
    Scene scene;
    const Body bob = scene.point_mass(1, {0.3, 0, -std::sqrt(0.91)}, Vec::Zero());
    scene.add(Rod{{scene.moving_ground(Vec::Zero(), {0, 0, 0.05}, 4), bob.centre}, 1});
    scene.add(ConstantForce{{bob.centre}, {0, 0, -9.81}});
    Multibody motion(std::move(scene), 2.0 / steps, composed(composition));
    advance(motion, steps);
    return Eigen::VectorXd(motion.configuration()(motion(bob.centre)));
  };
  const Eigen::VectorXd exact = end(2000, compositions::kahan_li_8);
  const auto with = [&](int steps) { return end(steps, compositions::suzuki); };
  EXPECT_NEAR(laws::measured_order({with, exact, 40, 1e-11}), 4, 0.2);
}

TEST(Multibody, ComposedStepsGoBackAndGoOnFromAState) {
  const auto options = composed(compositions::kahan_li_6);
  Machine machine, one, other;
  Multibody motion(std::move(machine.scene), 0.02, options);
  const auto start = motion.state();
  advance(motion, 100);
  motion.reverse();
  advance(motion, 100);
  for (std::size_t f = 0; f < start.momentum.size(); ++f)
    EXPECT_LT((start.at.x[f] - motion.configuration().x[f]).norm(), 1e-9);

  EXPECT_NE(motion.multipliers(), std::vector<double>(motion.multipliers().size())) << "those of the last stage";

  Multibody unbroken(std::move(one.scene), 0.02, options);
  Multibody resumed(std::move(other.scene), 0.02, options);
  advance(unbroken, 37);
  NumberArchive kept;
  unbroken.serialize(kept);
  NumberArchive read(kept.numbers());
  resumed.serialize(read);
  EXPECT_TRUE(read.at_end());
  advance(unbroken, 50);
  advance(resumed, 50);
  EXPECT_EQ(unbroken.configuration().x, resumed.configuration().x);
  EXPECT_EQ(unbroken.state().spin, resumed.state().spin);
  EXPECT_EQ(unbroken.time(), resumed.time());
}

TEST(Multibody, AComposedStepThatFailsChangesNothingAndAllocatesNothing) {
  Scene scene;
  const Body a = scene.point_mass(1, {1, 0, 0}, {0, 6, 0});
  scene.add(Rod{{scene.ground(Vec::Zero()), a.centre}, 1});
  Multibody motion(std::move(scene), 0.2, composed(compositions::triple_jump));
  const auto before = motion.state();
  EXPECT_FALSE(motion.advance().converged());
  EXPECT_EQ(motion.index(), 0);
  EXPECT_EQ(motion.time(), 0);
  EXPECT_EQ(motion.configuration().x[0], before.at.x[0]);
  EXPECT_EQ(motion.state().momentum[0], before.momentum[0]);

  Machine machine;
  Multibody runs(std::move(machine.scene), 0.01, composed(compositions::suzuki));
  advance(runs, 1);
  const long count = allocation_count();
  if (count < 0) GTEST_SKIP() << "allocations cannot be counted here";
  advance(runs, 20);
  EXPECT_EQ(allocation_count(), count);
}

TEST(Multibody, WhatCannotBeTakenBackIsNotComposed) {
  Machine damped(0.1);
  EXPECT_THROW(Multibody(std::move(damped.scene), 0.01, composed(compositions::suzuki)), std::invalid_argument);
  Scene rolling;
  const Body ball = rolling.rigid_body(1, Vec::Constant(0.4), {0, 0, 1}, upright, Vec::Zero(), Vec::Zero());
  rolling.add(BodySpin{{}, {ball.attitude}, {0, 0, 1}, 0});
  EXPECT_THROW(Multibody(std::move(rolling), 0.01, composed(compositions::suzuki)), std::invalid_argument);
}

TEST(Multibody, DampingTakesEnergy) {
  Machine machine(0.5);
  Multibody motion(std::move(machine.scene), 0.005);
  const double first = energy(motion);
  advance(motion, 20000);
  EXPECT_LT(energy(motion), first - 0.5);
  EXPECT_NEAR(energy(motion) + motion.dissipated(), first, 1e-3);
}

/// A dashpot between two bodies, a ball joint that turns hard: what they take is what is lost, and momenta are kept.
TEST(Multibody, DampersTakeEnergyAndKeepMomenta) {
  const auto error = [](double h) {
    Scene scene;
    const Vec moments(0.3, 0.4, 0.5);
    const Body a = scene.rigid_body(1, moments, {0, 0, 0}, upright, {0.3, 0, 0.1}, {0, 0, 1});
    const Body b = scene.rigid_body(2, moments, {1, 0, 0}, upright, {0.3, 1, 0.1}, {0.2, 0.1, -2});
    const Body c = scene.rigid_body(1.5, moments, {2, 0.3, 0}, upright, {-0.5, 0, 0}, {0.3, 0, 1});
    scene.add(Coincidence{{scene.point_of(a, {0.5, 0, 0}), scene.point_of(b, {-0.5, 0, 0})}});
    scene.add(Damper<RelativeTurn>{{{}, {a.attitude, b.attitude}}, 0.2});
    scene.add(Damper<Length>{{{scene.point_of(b, {0.5, 0.1, 0}), scene.point_of(c, {0, 0.2, 0})}}, 0.8});
    Multibody motion(std::move(scene), h);
    motion.make_tangent();
    const double before = energy(motion);
    const Vec p = motion.linear_momentum(motion.momenta());
    const Vec l = motion.angular_momentum(motion.momenta());
    advance(motion, std::lround(2 / h));
    EXPECT_GT(motion.dissipated(), 0.2);
    EXPECT_LT((motion.linear_momentum(motion.momenta()) - p).norm(), 1e-13);
    EXPECT_LT((motion.angular_momentum(motion.momenta()) - l).norm(), 1e-12);
    return std::abs(energy(motion) + motion.dissipated() - before);
  };
  EXPECT_NEAR(std::log2(error(0.01) / error(0.005)), 2, 0.2);
}

/// A hinge that rubs: the rate decays by (1 - x) / (1 + x) a step, x = c h / (2 I).
TEST(Multibody, ADampedHingeSlowsDown) {
  Scene scene;
  const Body wheel = scene.pivoted_body({1, 1.2, 0.8}, Vec::Zero(), upright, {0, 0, 3});
  for (const Vec& u : {Vec(Vec::UnitX()), Vec(Vec::UnitY())})
    scene.add(FixedAngle{{}, {Attitude{}, wheel.attitude}, u, {0, 0, 1}, 0});
  scene.add(Damper<HingeTurn>{{{}, {Attitude{}, wheel.attitude}, {0, 0, 1}, {0, 0, 1}, 0}, 0.7});
  Multibody motion(std::move(scene), 0.05);
  advance(motion, 100);
  const double x = 0.7 * 0.05 / (2 * 0.8);
  EXPECT_NEAR(motion.momenta().spin[0](2), 2.4 * std::pow((1 - x) / (1 + x), 100), 1e-14);
  EXPECT_NEAR(energy(motion) + motion.dissipated(), 0.5 * 0.8 * 9, 1e-13);
}

/// The harder it rubs, the nearer to a weld.
TEST(Multibody, AHardDamperIsAJoint) {
  Scene scene;
  const Body a = scene.rigid_body(1, {1, 1, 1}, {0, 0, 0}, upright, {0, 0, 0}, {0, 0, 1});
  const Body b = scene.rigid_body(1, {1, 1, 1}, {0, 0, 1}, upright, {0, 0, 0}, {0, 0, -0.5});
  scene.add(Damper<RelativeTurn>{{{}, {a.attitude, b.attitude}}, 1e12});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 1);
  const auto spin = motion.momenta().spin;
  advance(motion, 1);
  const auto next = motion.momenta().spin;
  EXPECT_NEAR(0.5 * (spin[0](2) + next[0](2)), 0.25, 1e-9);
  EXPECT_NEAR(0.5 * (spin[1](2) + next[1](2)), 0.25, 1e-9);
}

/// A pendulum whose support is shaken: as the one seen from the support, under the gravity felt there.
TEST(Multibody, AMovedSupportIsAGravityThatChanges) {
  constexpr double w = 3;
  constexpr double amplitude = 0.2;
  const auto error = [&](int steps) {
    const double h = 2.0 / steps;
    Scene scene;
    const Body bob = scene.point_mass(1, {1, 0, 0}, {0, 0, 0});
    scene.add(Rod{{scene.moving_ground(Vec::Zero(), {0, 0, amplitude}, w), bob.centre}, 1});
    scene.add(ConstantForce{{bob.centre}, {0, 0, -9.81}});
    Multibody motion(std::move(scene), h);
    EXPECT_EQ(motion.velocity_defect(), 0);
    advance(motion, steps);
    EXPECT_LT(motion.constraint_residual(), 1e-14);
    const double t = motion.time();
    const Vec velocity = motion.momenta().linear[0] - Vec(0, 0, amplitude * w * std::sin(w * t));
    const Vec arm = motion.configuration()(motion(bob.centre)) - Vec(0, 0, amplitude * (1 - std::cos(w * t)));
    EXPECT_LT(std::abs(velocity.dot(arm)), 1e-13) << "reported velocities agree with the support's";
    // theta'' = -(g + z'') sin theta, theta from below; by Runge and Kutta in fine steps.
    Eigen::Vector2d y(M_PI / 2, 0);
    const auto rate = [&](double at, const Eigen::Vector2d& z) {
      return Eigen::Vector2d(z(1), -(9.81 + amplitude * w * w * std::cos(w * at)) * std::sin(z(0)));
    };
    constexpr int fine = 20000;
    const double k = 2.0 / fine;
    for (int i = 0; i < fine; ++i) {
      const double at = i * k;
      const Eigen::Vector2d k1 = rate(at, y);
      const Eigen::Vector2d k2 = rate(at + 0.5 * k, y + 0.5 * k * k1);
      const Eigen::Vector2d k3 = rate(at + 0.5 * k, y + 0.5 * k * k2);
      const Eigen::Vector2d k4 = rate(at + k, y + k * k3);
      y += k / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return std::abs(arm(0) - std::sin(y(0))) + std::abs(arm(2) + std::cos(y(0)));
  };
  EXPECT_NEAR(std::log2(error(200) / error(400)), 2, 0.1);
}

/// A hinge that turns at a given rate.
TEST(Multibody, ADrivenHingeKeepsItsRate) {
  Scene scene;
  const Body arm = scene.rigid_body(1, {0.1, 0.2, 0.2}, {0.5, 0, 0}, upright, {0, 1, 0}, {0, 0, 2});
  scene.add(Coincidence{{scene.ground(Vec::Zero()), scene.point_of(arm, {-0.5, 0, 0})}});
  for (const Vec& u : {Vec(Vec::UnitX()), Vec(Vec::UnitY())})
    scene.add(FixedAngle{{}, {Attitude{}, arm.attitude}, u, {0, 0, 1}, 0});
  scene.add(HingeTurn{{}, {Attitude{}, arm.attitude}, {0, 0, 1}, {0, 0, 1}, 2});
  scene.add(ConstantForce{{arm.centre}, {0, -9.81, 0}});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 300);
  const Vec tip = motion.configuration()(motion(arm.centre));
  EXPECT_LT((tip - 0.5 * Vec(std::cos(6.0), std::sin(6.0), 0)).norm(), 1e-12);
}

/// Between two bodies that tumble: the angle is kept, and so is the angular momentum.
TEST(Multibody, ADrivenHingeOfTumblingBodiesKeepsItsAngle) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    Scene scene;
    scene.rotation = map;
    const Body a = scene.rigid_body(1, {0.1, 0.2, 0.25}, {0, 0, 0}, upright, {0, 0, 0}, {0.3, 0.2, 0});
    const Body b = scene.rigid_body(1, {0.15, 0.2, 0.12}, {1, 0, 0}, upright, {0, 0, 0}, {0.3, 0.2, 2});
    scene.add(Coincidence{{scene.point_of(a, {0.5, 0, 0}), scene.point_of(b, {-0.5, 0, 0})}});
    for (const Vec& u : {Vec(Vec::UnitX()), Vec(Vec::UnitY())})
      scene.add(FixedAngle{{}, {a.attitude, b.attitude}, u, {0, 0, 1}, 0});
    scene.add(HingeTurn{{}, {a.attitude, b.attitude}, {0, 0, 1}, {0, 0, 1}, 2});
    Multibody motion(std::move(scene), 0.02);
    motion.make_tangent();
    const Vec l = motion.angular_momentum(motion.momenta());
    advance(motion, 1000);
    const Mat turn = motion.configuration().attitude[0].transpose() * motion.configuration().attitude[1];
    EXPECT_LT((turn - SO3::exp(Vec(0, 0, 2 * motion.time()))).norm(), 1e-10);
    EXPECT_LT((motion.angular_momentum(motion.momenta()) - l).norm(), 1e-12);
    EXPECT_LT(motion.velocity_defect(), 1e-1);
  }
}

/// An island on which nothing acts moves where its ground does.
TEST(Multibody, AMovedGroundTakesWhatRestsAlong) {
  Scene scene;
  const Body bob = scene.point_mass(1, {1, 0, 0}, Vec::Zero());
  scene.add(Rod{{scene.moving_ground(Vec::Zero(), {0.1, 0, 0}, 1), bob.centre}, 1});
  const Body pulled = scene.point_mass(1, {1, 1, 0}, Vec::Zero());
  scene.add(Damper<Length>{{{scene.moving_ground({0, 1, 0}, {0.1, 0, 0}, 1), pulled.centre}}, 3});
  Multibody motion(std::move(scene), 0.01);
  advance(motion, 200);
  EXPECT_NEAR(motion.configuration()(motion(bob.centre))(0), 1 + 0.1 * (1 - std::cos(2.0)), 1e-12);
  EXPECT_GT(motion.configuration()(motion(pulled.centre))(0), 1.05);
  EXPECT_LT(motion.constraint_residual(), 1e-14);
}

/// What a step that fails has tried is forgotten: the state, and what is told of it.
TEST(Multibody, AStepThatFailsIsForgottenUnderTheVakonomicPrinciple) {
  const auto make = [] {
    Scene scene;
    const Body body = scene.planar_body(1, 1, {0, 0, 0}, {1, 0, 0.6});
    scene.add(Vakonomic<Blade>{{{scene.planar_place(body)}, 0, 0, 0}, {40}});
    scene.add(Vakonomic<Blade>{{{scene.planar_place(body)}, -M_PI / 2, 0, 1}, {80}});
    return scene;
  };
  Multibody motion(make(), 0.3);
  int taken = 0;
  Multibody::Momenta before = motion.momenta();
  while (taken < 1000 && motion.advance().converged()) {
    before = motion.momenta();
    ++taken;
  }
  ASSERT_LT(taken, 1000);
  EXPECT_EQ(motion.momenta().linear[0], before.linear[0]);
  EXPECT_FALSE(motion.advance().converged());
  EXPECT_EQ(motion.momenta().linear[0], before.linear[0]);
}

/// Large angles and far places are solved to their round-off.
TEST(Multibody, VakonomicBladesFarAwayAndTurnedOftenAreSolved) {
  Scene scene;
  const Body a = scene.planar_body(1, 0.3, {1e4, 0, 1000}, {std::cos(1000), std::sin(1000), 0});
  const Vec ahead(std::cos(1000), std::sin(1000), 0);
  const Vec behind = Vec(1e4, 0, 0) - 1.5 * ahead;
  const Body b = scene.planar_body(0.8, 0.2, {behind(0), behind(1), 1000}, {std::cos(1000), std::sin(1000), 0});
  scene.add(Coincidence{{scene.point_of(a, {-0.5, 0, 0}), scene.point_of(b, {1, 0, 0})}});
  scene.add(Vakonomic<Blade>{{{scene.planar_place(a)}, 0, 0, 0}, {0.3}});
  scene.add(Vakonomic<Blade>{{{scene.planar_place(b)}, 0, 0, 0}, {0.1}});
  Multibody motion(std::move(scene), 0.01);
  EXPECT_LT(motion.velocity_defect(), 1e-8) << "multipliers are no velocities";
  advance(motion, 3000);
  EXPECT_LT(motion.constraint_residual(), 1e-13);
}

/// What is told of nonholonomic momenta is of order two: of a sleigh, and of a hinge that is driven.
TEST(Multibody, NonholonomicMomentaAreOfOrderTwo) {
  ChaplyginSleigh system;
  const auto end = system.closed_form(system.sliding(0.8, 0.3), 3);
  const auto error = [&](int steps) {
    Scene scene;
    const Body body = scene.planar_body(1, 1, {1, 0, 0}, {0.3, 0.8, 0.8});
    scene.add(Blade{{scene.planar_place(body)}, 0, -1, 0});
    Multibody motion(std::move(scene), 3.0 / steps);
    advance(motion, steps);
    return std::abs(motion.momenta().linear[0](2) - end(0));
  };
  EXPECT_NEAR(std::log2(error(300) / error(600)), 2, 0.1);
}

/// One island, one principle.
TEST(Multibody, PrinciplesAreNotMixed) {
  const auto mixed = [](bool drag) {
    Scene scene;
    const Body a = scene.planar_body(1, 1, {0, 0, 0}, {1, 0, 0});
    const Body b = scene.planar_body(1, 1, {1, 0, 0}, {1, 0, 0});
    scene.add(Vakonomic<Blade>{{{scene.planar_place(a)}, 0, 0, 0}, {0.3}});
    if (drag) {
      scene.damp(a, 1, 0);
    } else {
      scene.add(Blade{{scene.planar_place(b)}, 0, 0, 0});
      scene.add(Rod{{a.centre, b.centre}, 1});
    }
    return Multibody(std::move(scene), 0.01);
  };
  EXPECT_THROW(mixed(false), std::domain_error);
  EXPECT_THROW(mixed(true), std::domain_error);
}

/// Two bodies that circle each other closely and far: steps shrink with their distance, the way back is the way there,
/// and the error is a fraction of that of as many equal steps.
TEST(Multibody, ControlledStepsFollowTheAttraction) {
  constexpr double e = 0.9;
  const auto make = [] {
    Scene scene;
    const Body body = scene.point_mass(1, {1 - e, 0, 0}, {0, std::sqrt((1 + e) / (1 - e)), 0});
    scene.add(CentralGravity{{body.centre}, Vec::Zero(), 1});
    return scene;
  };
  const auto drift = [](Multibody& motion, int steps) {
    const double before = energy(motion);
    double worst = 0;
    for (int k = 0; k < steps; ++k) {
      EXPECT_TRUE(motion.advance().converged());
      worst = std::max(worst, std::abs(energy(motion) - before));
    }
    return worst;
  };
  Multibody controlled(make(), 0.002, {.controlled = true});
  constexpr int steps = 3000;
  const double with = drift(controlled, steps);
  EXPECT_GT(controlled.time(), 2 * M_PI);
  Multibody equal(make(), controlled.time() / steps);
  EXPECT_LT(with, 0.1 * drift(equal, steps));
  Multibody back(make(), 0.002, {.controlled = true});
  const Vec start = back.configuration().x[0];
  advance(back, 1000);
  EXPECT_GT((back.configuration().x[0] - start).norm(), 0.1);
  back.reverse();
  advance(back, 1000);
  EXPECT_LT((back.configuration().x[0] - start).norm(), 1e-9);
  Multibody whole(make(), 0.002, {.controlled = true});
  advance(whole, 50);
  Multibody taken_up(make(), 0.002, {.controlled = true});
  taken_up.restore(whole.state());
  advance(whole, 100);
  advance(taken_up, 100);
  EXPECT_EQ(whole.configuration().x[0], taken_up.configuration().x[0]);
  EXPECT_EQ(whole.time(), taken_up.time());
  Scene other = make();
  other.add(ConstantForce{{other.point_mass(1, Vec::Ones(), Vec::Zero()).centre}, {0, 0, 1}});
  EXPECT_THROW(Multibody(std::move(other), 0.01, {.controlled = true}), std::invalid_argument);
}

/// The torques of attractions change their energy, too: h follows |U|^(-3/2) of a body that turns about a point.
TEST(Multibody, ControlledStepsFollowWhatTurns) {
  Scene scene;
  const Body body = scene.pivoted_body({1.2, 1.2, 1.1}, Vec::Zero(), upright, {0, 0, 0.5});
  scene.add(CentralGravity{{scene.point_of(body, {1, 0, 0})}, {1.5, 0.3, 0}, 1});
  Multibody motion(std::move(scene), 0.002, {.controlled = true});
  const auto ratio = [&] { return motion.step() * std::pow(-motion.potential_energy(), 1.5); };
  advance(motion, 1);
  const double first = ratio();
  const double step = motion.step();
  advance(motion, 1500);
  EXPECT_GT(std::abs(motion.step() / step - 1), 0.05);
  EXPECT_NEAR(ratio() / first, 1, 0.01);
}

/// A sleigh on a blade ahead of its centre, in closed form.
TEST(Multibody, ASleighMovesInClosedForm) {
  ChaplyginSleigh system;
  const auto start = system.sliding(0.8, 0.3);
  const auto error = [&](int steps) {
    const double h = 3.0 / steps;
    Scene scene;
    // The blade behind the centre of mass by a: the centre moves across at a w.
    const Body body = scene.planar_body(1, 1, {1, 0, 0}, {0.3, 0.8, 0.8});
    scene.add(Blade{{scene.planar_place(body)}, 0, -1, 0});
    Multibody motion(std::move(scene), h);
    const double before = energy(motion);
    advance(motion, steps);
    EXPECT_LT(motion.constraint_residual(), 1e-14);
    EXPECT_NEAR(energy(motion), before, 1e-3);
    const auto end = system.closed_form(start, 3);
    const Vec p = motion.momenta().linear[0];
    const double angle = motion.configuration().x[0](2);
    return std::abs(p(2) - end(0)) + std::abs(std::cos(angle) * p(0) + std::sin(angle) * p(1) - end(1));
  };
  EXPECT_LT(error(300), 1e-3);
  EXPECT_NEAR(std::log2(error(300) / error(600)), 2, 0.1);
}

/// Two blades under the vakonomic principle: a unicycle that pays for turning, on an elastica. |p| and the energy of
/// its equations are constant to the order of the step, and its force in space to round-off.
TEST(Multibody, AVakonomicUnicycleFollowsAnElastica) {
  const auto change = [](int steps) {
    Scene scene;
    const Body body = scene.planar_body(1, 1, {0, 0, 0}, {1, 0, 0.4});
    const Site place = scene.planar_place(body);
    scene.add(Vakonomic<Blade>{{{place}, 0, 0, 0}, {0.7}});
    scene.add(Vakonomic<Blade>{{{place}, -M_PI / 2, 0, 1}, {0.5}});
    Multibody motion(std::move(scene), 4.0 / steps);
    const Vec force = motion.state().momentum[0];
    const double energy_before = 0.5 * 0.4 * 0.4 + 1 + 0.5;  // w^2 / 2 + v p1, p1 = m v + lambda
    EXPECT_NEAR(force(0), 1.5, 1e-15);
    EXPECT_NEAR(force(1), 0.7, 1e-15);
    advance(motion, steps);
    const Vec after = motion.state().momentum[0];
    EXPECT_LT((after - force).head<2>().norm(), 1e-13);
    EXPECT_LT(motion.constraint_residual(), 1e-14);
    const Vec x = motion.configuration().x[0];
    EXPECT_NEAR(after(2) + x(0) * after(1) - x(1) * after(0), force(2), 1e-13) << "the moment";
    EXPECT_GT(std::abs(x(2)), 0.3);
    return std::abs(0.5 * after(2) * after(2) + std::cos(x(2)) * after(0) + std::sin(x(2)) * after(1) - energy_before);
  };
  EXPECT_NEAR(std::log2(change(200) / change(400)), 2, 0.2);
}

/// Two hinged bars and a bob on a rod in free flight: momenta are conserved to round-off.
TEST(Multibody, FreeFlightKeepsMomenta) {
  Scene scene;
  const Body a = scene.rigid_body(1, {0.1, 0.2, 0.25}, {0, 0, 0}, upright, {0.1, 0.2, 0}, {0, 0, 0});
  const Body b = scene.rigid_body(2, {0.3, 0.2, 0.25}, {1, 0, 0}, upright, {0.1, 0.2, 0}, {0, 0, 0});
  const Body c = scene.point_mass(0.5, {0.5, 1, 0}, {0.1, 0.2, 3});
  scene.add(Coincidence{{scene.point_of(a, {0.5, 0, 0}), scene.point_of(b, {-0.5, 0, 0})}});
  // A hinge about the second axis.
  scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {1, 0, 0}, {0, 1, 0}});
  scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {0, 0, 1}, {0, 1, 0}});
  scene.add(Rod{{scene.point_of(a, {0.5, 0, 0}), c.centre}, 1});
  scene.add(InverseSquare{{a.centre, c.centre}, 0.3});
  scene.add(TorsionSpring{{}, {a.attitude, b.attitude}, {1, 0, 0}, {1, 0, 0}, 2.0});
  Multibody motion(std::move(scene), 0.01);
  const auto first = motion.momenta();
  const Vec p = motion.linear_momentum(first);
  const Vec l = motion.angular_momentum(first);
  for (int k = 0; k < 20; ++k) {
    advance(motion, 500);
    const auto m = motion.momenta();
    EXPECT_LT((motion.linear_momentum(m) - p).norm(), 1e-12);
    EXPECT_LT((motion.angular_momentum(m) - l).norm(), 1e-11);
  }
}

/// A motor turns two hinged bodies against each other: their angular momentum stays.
TEST(Multibody, AMotorActsOnBothOfItsBodies) {
  Scene scene;
  const Body a = scene.rigid_body(1, {0.1, 0.2, 0.25}, {0, 0, 0}, upright, {0.1, 0.2, 0}, {0, 0, 0});
  const Body b = scene.rigid_body(2, {0.3, 0.2, 0.25}, {1, 0, 0}, upright, {0.1, 0.2, 0}, {0, 0, 0});
  scene.add(Coincidence{{scene.point_of(a, {0.5, 0, 0}), scene.point_of(b, {-0.5, 0, 0})}});
  scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {1, 0, 0}, {0, 1, 0}});
  scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {0, 0, 1}, {0, 1, 0}});
  scene.add(Motor{{}, {a.attitude, b.attitude}, {0, 0.4, 0}, 3, 0.2});
  Multibody motion(std::move(scene), 0.01);
  const Vec l = motion.angular_momentum(motion.momenta());
  advance(motion, 1000);
  const auto m = motion.momenta();
  EXPECT_LT((motion.angular_momentum(m) - l).norm(), 1e-12);
  EXPECT_GT(m.spin[0].norm(), 0.01);
}

/// Six equal bars in a plane, hinged to a ring, of bodies in space: three of the hinges' equations depend on the
/// others.
TEST(Multibody, RowsThatDependOnOthersAreLeftOut) {
  Scene scene;
  std::vector<Body> bars;
  constexpr double turn = M_PI / 3;
  for (int k = 0; k < 6; ++k) {
    const double angle = turn * k;
    const Vec centre = std::sqrt(0.75) * Vec(std::sin(angle), -std::cos(angle), 0);
    bars.push_back(scene.rigid_body(1, {0.01, 0.1, 0.1}, centre, {std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
                                    Vec::Zero(), Vec::Zero()));
  }
  for (int k = 0; k < 6; ++k) {
    const Body& a = bars[std::size_t(k)];
    const Body& b = bars[std::size_t((k + 1) % 6)];
    scene.add(Coincidence{{scene.point_of(a, {0.5, 0, 0}), scene.point_of(b, {-0.5, 0, 0})}});
    scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {1, 0, 0}, {0, 0, 1}});
    scene.add(FixedAngle{{}, {a.attitude, b.attitude}, {0, 1, 0}, {0, 0, 1}});
  }
  scene.add(ConstantForce{{bars[0].centre}, {0, 1, 0}});
  scene.add(ConstantForce{{bars[3].centre}, {0.2, -1, 0}});
  Multibody motion(std::move(scene), 0.002);
  EXPECT_EQ(motion.rows(), 30);
  EXPECT_EQ(motion.dependent_rows(), 3);
  const double first = energy(motion);
  advance(motion, 500);
  EXPECT_LT(motion.constraint_residual(), 1e-13);
  EXPECT_NEAR(energy(motion), first, 1e-4);
}

/// The same ring of planar bodies, with pins.
TEST(Multibody, PlanarBodiesMoveAsBodiesInSpaceDo) {
  const auto run = [](bool planar) {
    Scene scene;
    std::vector<Body> bars;
    for (int k = 0; k < 3; ++k) {
      const double angle = 0.4 * k;
      const Vec centre(0.5 + k * 0.9, 0.1 * k, 0);
      if (planar) {
        bars.push_back(scene.planar_body(1, 0.1, {centre(0), centre(1), angle}, {0, 0.1, 0}));
      } else {
        bars.push_back(scene.rigid_body(1, {0.01, 0.1, 0.1}, centre, {std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
                                        {0, 0.1, 0}, Vec::Zero()));
      }
    }
    for (int k = 0; k < 2; ++k)
      scene.add(Spring{
          {scene.point_of(bars[std::size_t(k)], {0.3, 0.2, 0}), scene.point_of(bars[std::size_t(k + 1)], {-0.3, 0, 0})},
          7,
          0.1});
    scene.add(Rod{{scene.ground({0, 0.3, 0}), scene.point_of(bars[0], {-0.2, 0.1, 0})},
                  (Vec(0.3, 0.1, 0) - Vec(0, 0.3, 0)).norm()});
    Multibody motion(std::move(scene), 0.01);
    advance(motion, 300);
    return motion.configuration()(motion(bars[2].centre));
  };
  EXPECT_LT((run(true) - run(false)).norm(), 1e-11);
}

/// Torques, motors and torsion springs turn bodies in the plane as they turn them in space about an axis of inertia.
TEST(Multibody, PlanarBodiesAreTurnedAsBodiesInSpaceAre) {
  constexpr double angles[] = {0.4, -0.7};
  const auto run = [&](bool planar) {
    Scene scene;
    std::vector<Body> bars;
    for (const double angle : angles) {
      const Vec centre(angle, 0.1, 0);
      bars.push_back(planar ? scene.planar_body(1, 0.1, {centre(0), centre(1), angle}, Vec::Zero())
                            : scene.rigid_body(1, {0.01, 0.1, 0.1}, centre,
                                               {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}, Vec::Zero(),
                                               Vec::Zero()));
    }
    const Vec between = Vec(angles[0] + angles[1], 0.2, 0) / 2;
    const auto arm = [&](int k) -> Vec {
      const double angle = angles[k];
      const Vec d = between - Vec(angle, 0.1, 0);
      return {std::cos(angle) * d(0) + std::sin(angle) * d(1), std::cos(angle) * d(1) - std::sin(angle) * d(0), 0};
    };
    scene.add(Coincidence{{scene.point_of(bars[0], arm(0)), scene.point_of(bars[1], arm(1))}});
    constexpr double torque = 0.3;
    constexpr double driven = 0.5;
    constexpr double rate = 2;
    constexpr double phase = 0.2;
    constexpr double stiffness = 0.8;
    if (planar) {
      const std::array<Site, 2> places{scene.planar_place(bars[0]), scene.planar_place(bars[1])};
      scene.add(ConstantForce{{places[0]}, {0, 0, torque}});
      scene.add(PeriodicForce{{places[0]}, {0, 0, -driven}, rate, phase});
      scene.add(PeriodicForce{{places[1]}, {0, 0, driven}, rate, phase});
      scene.add(PlanarTorsionSpring{places, stiffness, angles[1] - angles[0]});
      scene.add(PlanarTorsionSpring{{scene.ground(Vec::Zero()), places[1]}, stiffness, angles[1]});
    } else {
      const auto seen = [&](int k) -> Vec { return {std::cos(angles[k]), -std::sin(angles[k]), 0}; };
      scene.add(BodyTorque{{}, {bars[0].attitude}, {0, 0, torque}});
      scene.add(Motor{{}, {bars[0].attitude, bars[1].attitude}, {0, 0, driven}, rate, phase});
      scene.add(TorsionSpring{{}, {bars[0].attitude, bars[1].attitude}, seen(0), seen(1), stiffness});
      scene.add(TorsionSpring{{}, {Attitude{}, bars[1].attitude}, {1, 0, 0}, seen(1), stiffness});
    }
    Multibody motion(std::move(scene), 0.01);
    advance(motion, 400);
    Vector<double, 6> out;
    out << motion.configuration()(motion(bars[0].centre)), motion.configuration()(motion(bars[1].centre));
    return out;
  };
  EXPECT_LT((run(true) - run(false)).norm(), 1e-10);
}

/// Masses in another unit change nothing of the motion, and energies by that unit alone.
TEST(Multibody, MovesAlikeInEveryUnitOfMass) {
  const auto run = [](double unit) {
    Scene scene;
    const Body top =
        scene.rigid_body(unit, unit * Vec(1, 2, 2.5), {0, 0, -0.3}, upright, {-0.6, 0.03, 0}, {0.1, 2, 0.1});
    const Body bob = scene.point_mass(0.3 * unit, {0.5, 0, -0.3}, {-0.6, 0, -1});
    scene.add(Coincidence{{scene.ground(Vec::Zero()), scene.point_of(top, {0, 0, 0.3})}});
    scene.add(Rod{{top.centre, bob.centre}, 0.5});
    scene.add(ConstantForce{{top.centre}, {0, 0, -9.81 * unit}});
    scene.add(ConstantForce{{bob.centre}, {0, 0, -0.3 * 9.81 * unit}});
    scene.damp(top, 0, 0.1 * unit);
    Multibody motion(std::move(scene), 0.01);
    motion.make_tangent();
    advance(motion, 200);
    Vector<double, 4> out;
    out << motion.configuration()(motion(bob.centre)), energy(motion) / unit;
    return out;
  };
  const Vector<double, 4> plain = run(1);
  EXPECT_GT((plain.head<3>() - Vec(0.5, 0, -0.3)).norm(), 0.1);
  for (const int power : {-990, -700, -520, -300, 300, 520, 700, 1000})
    EXPECT_LT((run(std::ldexp(1.0, power)) - plain).norm(), 1e-9) << power;
}

TEST(Multibody, AStepAllocatesNothing) {
  Machine machine(0.1);
  Multibody motion(std::move(machine.scene), 0.01);
  const long before = allocation_count();
  if (before < 0) GTEST_SKIP() << "allocations cannot be counted here";
  advance(motion, 20);
  EXPECT_EQ(allocation_count(), before);
}

/// Where joints sit must not matter: at the origin, where places are sums that cancel, as little as elsewhere.
TEST(Multibody, JointsAtTheOriginAreSolvedAsElsewhere) {
  for (const Vec& pivot : {Vec(0, 0, 0), Vec(1e-9, 0, 0), Vec(0.1, 0, 0), Vec(30, -20, 10)})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Scene scene;
      const Quaternion tilted = Quaternion(std::cos(0.5), 0, -std::sin(0.5), 0);
      Body last{scene.ground(pivot), {}};
      Vec at = pivot;
      const Vec arm(0, 0, 0.7);
      for (int k = 0; k < 3; ++k) {
        const Vec centre = at - SO3::from_quaternion(tilted) * arm;
        const Body bar = scene.rigid_body(2, {0.1, 0.11, 0.05}, centre, tilted, Vec::Zero(), Vec::Zero());
        scene.add(Coincidence{{k == 0 ? last.centre : scene.point_of(last, -arm), scene.point_of(bar, arm)}});
        if (k == 0) {
          scene.add(FixedAngle{{}, {Attitude{}, bar.attitude}, {1, 0, 0}, {0, 1, 0}});
          scene.add(FixedAngle{{}, {Attitude{}, bar.attitude}, {0, 0, 1}, {0, 1, 0}});
        }
        scene.add(ConstantForce{{bar.centre}, {0, 0, -19.62}});
        last = bar;
        at = centre - SO3::from_quaternion(tilted) * arm;
      }
      Multibody motion(std::move(scene), h);
      advance(motion, 3000);
      EXPECT_LT(motion.constraint_residual(), 1e-14);
    }
}

/// Masses of 1 in line between two points of the ground, on rods that have no slack; a force acts on the first.
Scene taut_line(const Vec& force) {
  Scene scene;
  const Body a = scene.point_mass(1, {1, 0, 0}, Vec::Zero());
  const Body b = scene.point_mass(1, {2, 0, 0}, Vec::Zero());
  scene.add(Rod{{scene.ground(Vec::Zero()), a.centre}, 1});
  scene.add(Rod{{a.centre, b.centre}, 1});
  scene.add(Rod{{b.centre, scene.ground({3, 0, 0})}, 1});
  scene.add(ConstantForce{{a.centre}, force});
  return scene;
}

/// Taut in line, the third rod depends on the others; off the line it does not: the first step says so, however small
/// it is, not a wrong motion.
TEST(Multibody, WhereDependenceEndsTheFirstStepSaysSo) {
  for (const double h : {0.1, 0.01, 1e-3, 1e-4, 1e-6, 1e-9}) {
    Multibody motion(taut_line({0, 0, -9.81}), h);
    EXPECT_EQ(motion.dependent_rows(), 1);
    EXPECT_EQ(motion.advance().status, SolveStatus::singular) << h;
    EXPECT_TRUE(motion.dependence_ended()) << h;
  }
}

/// Nothing leaves the line where nothing pulls off it.
TEST(Multibody, WhereDependenceLastsStepsAreTaken) {
  for (const double h : {0.1, 1e-3, 1e-6}) {
    Multibody motion(taut_line({-3, 0, 0}), h);
    EXPECT_EQ(motion.dependent_rows(), 1);
    advance(motion, 10);
    EXPECT_EQ(motion.index(), 10);
  }
}

/// Dependence is a matter of geometry, not of masses.
TEST(Multibody, RowsOfALightBodyBetweenHeavyOnesAreIndependent) {
  Scene scene;
  const Body p = scene.point_mass(1, {0, 0, 0}, Vec::Zero());
  const Body q = scene.point_mass(1e-10, {1, 0, 0}, Vec::Zero());
  const Body r = scene.point_mass(1, {2, 0, 0}, Vec::Zero());
  scene.add(Rod{{p.centre, q.centre}, 1});
  scene.add(Rod{{q.centre, r.centre}, 1});
  scene.add(ConstantForce{{r.centre}, {0, 0.1, 0}});
  Multibody motion(std::move(scene), 0.01);
  EXPECT_EQ(motion.rows(), 2);
  EXPECT_EQ(motion.dependent_rows(), 0);
}

/// A pivot is a point of the ground: a joint there holds of itself, what else the joint asks for stays.
TEST(Multibody, JointsOfWhatDoesNotMoveHaveNoRows) {
  Scene scene;
  const Body top = scene.pivoted_body({1, 1, 1}, Vec::Zero(), upright, {0, 1, 0});
  scene.add(Coincidence{{scene.ground(Vec::Zero()), top.centre}});
  scene.add(FixedAngle{{}, {Attitude{}, top.attitude}, {1, 0, 0}, {0, 1, 0}});
  scene.add(FixedAngle{{}, {Attitude{}, top.attitude}, {0, 0, 1}, {0, 1, 0}});
  Multibody motion(std::move(scene), 0.01);
  EXPECT_EQ(motion.rows(), 2);
  advance(motion, 100);
  EXPECT_NEAR(motion.momenta().spin[0](1), 1, 1e-13);
}

TEST(Multibody, WhatRestsIsNotSolved) {
  Scene scene;
  const Body a = scene.point_mass(1, {0, 0, 0}, Vec::Zero());
  const Body b = scene.point_mass(1, {1, 0, 0}, Vec::Zero());
  scene.add(Rod{{a.centre, b.centre}, 1});
  Multibody motion(std::move(scene), 0.1);
  const StepReport report = motion.advance();
  EXPECT_TRUE(report.converged());
  EXPECT_EQ(report.iterations, 0);
}

TEST(Multibody, GoesOnFromAStateWithTheSameBits) {
  Machine one;
  Machine other;
  Multibody unbroken(std::move(one.scene), 0.01);
  Multibody resumed(std::move(other.scene), 0.01);
  for (int k = 0; k < 37; ++k) {
    // At many nodes: places that follow from others must not be computed anew.
    advance(unbroken, 1);
    resumed.restore(unbroken.state());
    EXPECT_EQ(resumed.configuration().x, unbroken.configuration().x);
    EXPECT_EQ(resumed.configuration().attitude, unbroken.configuration().attitude);
  }
  advance(unbroken, 100);
  advance(resumed, 100);
  const auto a = unbroken.state();
  const auto b = resumed.state();
  EXPECT_EQ(a.index, b.index);
  for (std::size_t f = 0; f < a.momentum.size(); ++f) {
    EXPECT_EQ(a.at.x[f], b.at.x[f]);
    EXPECT_EQ(a.momentum[f], b.momentum[f]);
  }
  for (std::size_t r = 0; r < a.spin.size(); ++r) {
    EXPECT_EQ(a.attitude[r], b.attitude[r]);
    EXPECT_EQ(a.spin[r], b.spin[r]);
  }
}

/// Two that attract each other and meet exactly.
TEST(Multibody, AStepToInfiniteForcesIsNotTaken) {
  Scene scene;
  const Body a = scene.point_mass(1, {-1, 0, 0}, {1, 0, 0});
  const Body b = scene.point_mass(1, {1, 0, 0}, {-1, 0, 0});
  scene.add(InverseSquare{{a.centre, b.centre}, 0});
  Multibody motion(std::move(scene), 1);
  const StepReport report = motion.advance();
  EXPECT_EQ(report.status, SolveStatus::not_finite);
  EXPECT_EQ(motion.index(), 0);
  EXPECT_EQ(motion.configuration().x[0], Vec(-1, 0, 0));
}

TEST(Multibody, AStepThatFailsChangesNothing) {
  Scene scene;
  const Body a = scene.point_mass(1, {1, 0, 0}, {0, 1000, 0});
  scene.add(Rod{{scene.ground(Vec::Zero()), a.centre}, 1});
  Multibody motion(std::move(scene), 0.1);
  const auto before = motion.state();
  EXPECT_FALSE(motion.advance().converged());
  EXPECT_EQ(motion.index(), 0);
  EXPECT_EQ(motion.configuration().x[0], before.at.x[0]);
  EXPECT_EQ(motion.state().momentum[0], before.momentum[0]);
}

/// An effect of a user's own, by its energy alone.
struct Tether {
  std::array<Site, 2> sites;
  std::array<Attitude, 1> attitudes;

  template <class S> S energy(const Vector<S, 3>& a, const Vector<S, 3>& b, const Matrix<S, 3, 3>& turned) const {
    return (b - a).squaredNorm() * (b - a).squaredNorm() * 0.25 + turned(2, 2) * a(2);
  }
};

TEST(Effects, ForcesAreDerivedFromTheEnergy) {
  Scene scene;
  const Body a = scene.rigid_body(1, {0.2, 0.3, 0.4}, {0, 0, 1}, Quaternion(1, 0.1, 0.2, 0).normalized(), {0, 0, 0.1},
                                  {0.3, 0, 0.2});
  const Body b = scene.point_mass(1, {1, 0.2, 0.3}, Vec::Zero());
  scene.add(Tether{{scene.point_of(a, {0, 0.2, 0}), b.centre}, {a.attitude}});
  Multibody motion(std::move(scene), 0.002);
  const double first = energy(motion);
  advance(motion, 2000);
  EXPECT_NEAR(energy(motion), first, 1e-4);
}

}  // namespace
}  // namespace lagroid
