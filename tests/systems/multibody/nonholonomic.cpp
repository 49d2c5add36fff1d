// Nonholonomic and vakonomic scenes of bodies.
#include "machine.hpp"

#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace lagroid::multibody_tests::nonholonomic_tests {
namespace {

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

}  // namespace
}  // namespace lagroid::multibody_tests::nonholonomic_tests
