// Joints and effects that are switched on and off on the way, and kicks.
#include "machine.hpp"

#include <lagroid/core/number_archive.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::multibody_tests::switches_tests {
namespace {

const Vec weight(0, 0, -9.81);

/// A bob on a rod that can be let go.
struct Sling {
  Body bob;
  Scene scene;

  Sling() {
    bob = scene.point_mass(1, {0, 0, -1}, {3, 0.5, 0});
    scene.begin_switch("string");
    scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1});
    scene.end_switch();
    scene.begin_switch("weight");
    scene.add(ConstantForce{{bob.centre}, weight});
    scene.end_switch();
  }
};
const std::vector<char> let_go{1, 0, 1}, in_the_void{1, 0, 0};

/// Where the bob is at the end, let go at the first time, by steps of this size.
Vec thrown(double h, double let_go_at, double end) {
  Sling sling;
  const Body bob = sling.bob;
  Multibody motion(std::move(sling.scene), h);
  advance(motion, std::lround(let_go_at / h));
  motion.switch_to(let_go);
  advance(motion, std::lround((end - let_go_at) / h));
  return motion.configuration()(motion(bob.centre));
}

TEST(Switches, WhatIsLetGoFliesWithTheVelocityThatItHad) {
  Sling sling;
  const Body bob = sling.bob;
  Multibody motion(std::move(sling.scene), 0.01);
  advance(motion, 37);
  const Vec x = motion.configuration()(motion(bob.centre));
  const Vec v = motion.momenta().linear.front();
  const double before = energy(motion);
  motion.switch_to(let_go);
  EXPECT_NEAR(energy(motion), before, 1e-14 * std::abs(before));
  EXPECT_LT((motion.momenta().linear.front() - v).norm(), 1e-15);
  advance(motion, 100);
  // Variational steps are exact under a constant force.
  const Vec flown = x + v + 0.5 * weight;
  EXPECT_LT((motion.configuration()(motion(bob.centre)) - flown).norm(), 1e-12);
  EXPECT_EQ(motion.constraint_residual(), 0);
  EXPECT_EQ(motion.dependent_rows(), 0);
}

TEST(Switches, AThrowHasTheOrderOfTheMethod) {
  const auto at = [](double h) { return thrown(h, 0.4, 1.2); };
  const Vec coarse = at(0.02), middle = at(0.01), fine = at(0.005);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2, 0.1);
}

TEST(Switches, EffectsThatAreOffDoNotAct) {
  Sling sling;
  const Body bob = sling.bob;
  Multibody motion(std::move(sling.scene), 0.01);
  advance(motion, 20);
  motion.switch_to(in_the_void);
  const Vec x = motion.configuration()(motion(bob.centre));
  const Vec v = motion.momenta().linear.front();
  EXPECT_EQ(motion.potential_energy(), 0);
  advance(motion, 100);
  EXPECT_LT((motion.configuration()(motion(bob.centre)) - (x + v)).norm(), 1e-12);
}

/// A string that catches what flies by keeps the angular momentum about its end, and takes what is along it.
TEST(Switches, ACatchIsInelastic) {
  Scene scene;
  const Body bob = scene.point_mass(2, {1, -0.75, 0}, {0, 1.5, 0});
  scene.begin_switch("string", false);
  scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1.25});
  scene.end_switch();
  Multibody motion(std::move(scene), 0.01);
  EXPECT_EQ(motion.constraint_residual(), 0);
  advance(motion, 100);  // until it is at (1, 0.75, 0)
  const Vec before = motion.angular_momentum(motion.momenta());
  EXPECT_LT(motion.violation(1), 1e-14);
  motion.switch_to({1, 1});
  const Vec x = motion.configuration()(motion(bob.centre));
  const Vec v = motion.momenta().linear.front() / 2;
  EXPECT_LT(std::abs(x.dot(v)), 1e-13);
  EXPECT_NEAR(v.norm(), 1.5 * 0.8, 1e-13);  // what is across the string
  advance(motion, 200);
  EXPECT_LT((motion.angular_momentum(motion.momenta()) - before).norm(), 1e-12);
  EXPECT_NEAR((motion.configuration()(motion(bob.centre))).norm(), 1.25, 1e-13);
  EXPECT_NEAR(motion.kinetic_energy(motion.momenta()), 1.44, 1e-12);
}

TEST(Switches, WhatDoesNotHoldIsSeen) {
  Sling sling;
  Multibody motion(std::move(sling.scene), 0.01);
  EXPECT_EQ(motion.violation(1), 0);  // it is on
  motion.switch_to(let_go);
  EXPECT_LT(motion.violation(1), 1e-15);
  advance(motion, 50);
  EXPECT_GT(motion.violation(1), 0.1);
}

/// Off and on again in one place nothing has happened, and names alone change no bit.
TEST(Switches, ThatAreNotUsedChangeNothing) {
  const auto end = [](bool named) {
    Scene scene;
    const Body bob = scene.point_mass(1, {0, 0, -1}, {3, 0.5, 0});
    if (named) scene.begin_switch("string");
    scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1});
    scene.add(ConstantForce{{bob.centre}, weight});
    scene.end_switch();
    Multibody motion(std::move(scene), 0.01);
    advance(motion, 100);
    return motion.configuration()(motion(bob.centre));
  };
  EXPECT_EQ(end(true), end(false));
  const auto again = [](bool switched) {
    Sling sling;
    const Body bob = sling.bob;
    Multibody motion(std::move(sling.scene), 0.01);
    advance(motion, 50);
    if (switched) {
      motion.switch_to(let_go);
      motion.switch_to({1, 1, 1});
    }
    advance(motion, 50);
    return motion.configuration()(motion(bob.centre));
  };
  EXPECT_LT((again(true) - again(false)).norm(), 1e-12);
}

/// Of two rods in line one depends on the other until that is cut.
TEST(Switches, WhatDependedOnWhatIsOffIsSolved) {
  Scene scene;
  const Body bob = scene.point_mass(1, {0, 0, -1}, {0.4, 0, 0});
  scene.begin_switch("first");
  scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1});
  scene.end_switch();
  scene.begin_switch("second");
  scene.add(Rod{{scene.ground(Vec::Zero()), bob.centre}, 1});
  scene.end_switch();
  scene.add(ConstantForce{{bob.centre}, weight});
  Multibody motion(std::move(scene), 0.01);
  EXPECT_EQ(motion.dependent_rows(), 1);
  advance(motion, 30);
  for (const std::vector<char>& on : {std::vector<char>{1, 0, 1}, {1, 1, 0}}) {
    motion.switch_to(on);
    EXPECT_EQ(motion.dependent_rows(), 0);
    advance(motion, 30);
    EXPECT_NEAR(motion.configuration()(motion(bob.centre)).norm(), 1, 1e-14);
  }
}

TEST(Switches, StatesAreRestoredWithTheirs) {
  const auto make = [] {
    Sling sling;
    return Multibody(std::move(sling.scene), 0.01);
  };
  Multibody motion = make();
  advance(motion, 30);
  motion.switch_to(let_go);
  advance(motion, 10);
  NumberArchive kept;
  motion.serialize(kept);
  Multibody other = make();
  NumberArchive read(kept.numbers());
  other.serialize(read);
  EXPECT_EQ(other.switches().on, let_go);
  advance(motion, 20);
  advance(other, 20);
  EXPECT_EQ(motion.configuration().x, other.configuration().x);
}

TEST(Switches, AKickAddsToTheMomentumWhatJointsAllow) {
  Sling sling;
  const Body bob = sling.bob;
  const int linear = sling.scene.linear_of(bob);
  Multibody motion(std::move(sling.scene), 0.01);
  advance(motion, 20);
  const Vec x = motion.configuration()(motion(bob.centre));
  const Vec before = motion.momenta().linear.front();
  const Vec across(0.3, -0.2, 0.1);
  motion.kick(linear, across + 5 * x, {}, Vec::Zero());
  const Vec wanted = before + across - x.dot(across) * x;
  EXPECT_LT((motion.momenta().linear.front() - wanted).norm(), 1e-13);
  const double kicked = energy(motion);
  advance(motion, 200);
  EXPECT_NEAR(energy(motion), kicked, 1e-3 * std::abs(kicked));
}

/// A part of a step, and what is left of it, end where a step does, to the order of the method.
TEST(Switches, StepsGoOnAfterParts) {
  const auto distance = [](double h) {
    const auto make = [h] {
      Machine machine;
      return Multibody(std::move(machine.scene), h);
    };
    Multibody whole = make(), parts = make();
    const long before = std::lround(0.1 / h);
    advance(whole, before);
    advance(parts, before);
    EXPECT_TRUE(whole.advance().converged());
    EXPECT_TRUE(parts.advance_by(0.3 * h).converged());
    EXPECT_TRUE(parts.advance_by(0.7 * h).converged());
    parts.end_part(whole.state());
    EXPECT_EQ(parts.step(), h);
    advance(whole, before);
    advance(parts, before);
    EXPECT_EQ(whole.time(), parts.time());
    double most = 0;
    for (std::size_t i = 0; i < whole.configuration().x.size(); ++i)
      most = std::max(most, (whole.configuration().x[i] - parts.configuration().x[i]).norm());
    return most;
  };
  EXPECT_GT(std::log2(distance(0.01) / distance(0.005)), 2.5);
}

/// Whatever pulls at a rod within a step, and wherever in it, the bob stays on its side of the rod: the other solution
/// of a step is the opposite place.
TEST(Switches, PullsWithinAStepLeaveABobOnItsSide) {
  constexpr double h = 0.01;
  const auto largest_move = [](double share, const auto& pull) {
    Sling sling;
    const Body bob = sling.bob;
    const int linear = sling.scene.linear_of(bob);
    Multibody motion(std::move(sling.scene), h);
    advance(motion, 20);
    const SceneState begin = motion.state();
    advance(motion, 1);
    const SceneState whole = motion.state();
    motion.restore(begin);
    EXPECT_TRUE(motion.advance_by(share * h).converged());
    pull(motion, linear);
    EXPECT_TRUE(motion.advance_by((1 - share) * h).converged());
    motion.end_part(whole);
    double most = 0;
    Vec before = motion.configuration()(motion(bob.centre));
    for (int k = 0; k < 50; ++k) {
      EXPECT_TRUE(motion.advance().converged());
      const Vec now = motion.configuration()(motion(bob.centre));
      most = std::max(most, (now - before).norm());
      before = now;
    }
    return most;
  };
  const auto strike = [](Multibody& motion, int linear) {
    motion.kick(linear, 3 * motion.configuration().x[0], {}, Vec::Zero());
  };
  const auto go_taut = [&strike](Multibody& motion, int linear) {
    motion.switch_to(let_go);
    strike(motion, linear);
    motion.switch_to({1, 1, 1});
  };
  for (const double share : {1e-3, 0.01, 0.1, 0.5, 0.9, 0.98, 0.99, 0.995, 0.998, 0.999}) {
    EXPECT_LT(largest_move(share, strike), 0.2) << share;
    EXPECT_LT(largest_move(share, go_taut), 0.2) << share;
  }
}

}  // namespace
}  // namespace lagroid::multibody_tests::switches_tests
