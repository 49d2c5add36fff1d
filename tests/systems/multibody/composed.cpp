// Composed and controlled steps of scenes of bodies.
#include "machine.hpp"

#include "../../support/allocation_counter.hpp"

#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace lagroid::multibody_tests::composed_tests {
namespace {

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

}  // namespace
}  // namespace lagroid::multibody_tests::composed_tests
