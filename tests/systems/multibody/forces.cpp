// Damping, drives, moved supports and forces of one's own in scenes of bodies.
#include "machine.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::multibody_tests::forces_tests {
namespace {

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
}  // namespace lagroid::multibody_tests::forces_tests
