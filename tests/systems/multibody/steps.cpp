// Steps of scenes of bodies: order, reversibility, momenta; steps that fail, and states to go on from.
#include "machine.hpp"

#include "../../support/allocation_counter.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::multibody_tests::steps_tests {
namespace {

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

}  // namespace
}  // namespace lagroid::multibody_tests::steps_tests
