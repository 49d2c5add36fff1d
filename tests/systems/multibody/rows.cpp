// Rows of the equations of scenes of bodies: which depend on others, which are not solved; planar bodies.
#include "machine.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::multibody_tests::rows_tests {
namespace {

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

}  // namespace
}  // namespace lagroid::multibody_tests::rows_tests
