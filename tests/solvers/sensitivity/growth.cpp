// By how much derivatives grow, in units of the motion's own.
#include <lagroid/solvers/sensitivity/growth/growth.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::sensitivity_growth_tests {
namespace {

/// A pendulum in units of so many metres, kilogrammes and seconds.
struct Bob : MechanicalSystem<Bob, 1> {
  double length = 1;
  double bob_mass = 1;
  double gravity = 1;
  static auto parameters() {
    return std::tuple(parameter("length", &Bob::length, "m", "of the rod"), quadrature_parameter());
  }
  double mass() const { return bob_mass; }
  /// Of the arc q / length.
  template <class S> S potential(const Vector<S, 1>& q) const {
    using std::cos;
    return cos(S(q(0) / varied<S>(length))) * (-bob_mass * gravity * varied<S>(length));
  }
};

Sensitivities of_bob(double metre, double kilogramme, double second, long steps) {
  Bob bob;
  bob.length = 1 / metre;
  bob.bob_mass = 1 / kilogramme;
  bob.gravity = second * second / metre;
  bob.h = 0.05 / second;
  const State<Pair<1>> start{Vector<double, 1>(0.1 / metre), Vector<double, 1>(2.2 * second / metre / kilogramme)};
  return sensitivities(bob, start, {.steps = steps, .parameters = {"length"}});
}

TEST(Growth, DoesNotKnowTheUnits) {
  const Sensitivities here = of_bob(1, 1, 1, 400);
  const Sensitivities there = of_bob(1e6, 1e-27, 1e-9, 400);
  ASSERT_TRUE(here.converged());
  ASSERT_TRUE(there.converged());
  EXPECT_NEAR(there.growth / here.growth, 1, 0.02);
  EXPECT_GT(here.growth, 5) << "it turns over, and neighbours leave each other";
  EXPECT_LT(here.growth, 5e3);
  EXPECT_NEAR(there.digits_left, here.digits_left, 0.1);
}

TEST(Growth, IsThatOfTheStartWhateverParametersThereAre) {
  // Near the rest the length does next to nothing at first, and a hundred times as much where the bob has moved.
  const State<Pair<1>> rest{Vector<double, 1>(0.0), Vector<double, 1>(1e-6)};
  const Sensitivities without = sensitivities(Bob(), rest, {.steps = 100});
  const Sensitivities with = sensitivities(Bob(), rest, {.steps = 100, .parameters = {"length"}});
  ASSERT_TRUE(without.converged() && with.converged());
  EXPECT_EQ(with.growth, without.growth);
  EXPECT_LT(with.growth, 2);
}

TEST(Growth, IsTheRateOfAnUnstableRest) {
  Growth growth(Eigen::Matrix2d::Identity());
  const double rate = 0.1;  // a saddle, with a momentum a million times as large as the place
  constexpr double unit = 1e6;
  const Eigen::Matrix2d step{{std::cosh(rate), std::sinh(rate) / unit}, {std::sinh(rate) * unit, std::cosh(rate)}};
  Eigen::MatrixXd directions = Eigen::Matrix2d::Identity();
  for (int k = 0; k < 100; ++k) {
    directions = step * directions;
    growth.after_a_step(directions);
    if (growth.wants_matrix()) growth.see(step);
  }
  EXPECT_NEAR(std::log(growth.largest()), rate * 100, std::log(2));
}

/// Two oscillators that act upon each other, by symplectic Euler; one entry that was zero is round-off.
double of_oscillators(double roundoff) {
  Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
  constexpr double h = 0.05;
  const Eigen::Matrix2d force{{-1.0, 0.3}, {0.3, -2.0}};
  step.topRightCorner<2, 2>() = h * Eigen::Matrix2d::Identity();
  step.bottomLeftCorner<2, 2>() = h * force;
  step.bottomRightCorner<2, 2>() += h * h * force;
  step(0, 3) += roundoff;
  Growth growth(Eigen::Matrix4d::Identity());
  Eigen::MatrixXd directions = Eigen::Matrix4d::Identity();
  for (int k = 0; k < 1000; ++k) {
    directions = step * directions;
    growth.after_a_step(directions);
    if (growth.wants_matrix()) growth.see(step);
  }
  return growth.largest();
}
TEST(Growth, DoesNotSeeRoundOff) { EXPECT_NEAR(of_oscillators(1e-18) / of_oscillators(0), 1, 0.01); }

TEST(Growth, OfWhatIsNoNumberIsInfinite) {
  Growth growth(Eigen::Matrix2d::Identity());
  growth.after_a_step(Eigen::Matrix2d::Constant(std::nan("")));
  EXPECT_TRUE(std::isinf(growth.largest()));
}

TEST(Growth, OfAFreeParticleIsNone) {
  Growth growth(Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d step{{1, 1e9}, {0, 1}};
  Eigen::MatrixXd directions = Eigen::Matrix2d::Identity();
  for (int k = 0; k < 1000; ++k) {
    directions = step * directions;
    growth.after_a_step(directions);
    if (growth.wants_matrix()) growth.see(step);
  }
  EXPECT_LT(growth.largest(), 2);
}

TEST(Growth, OfWhatIsAddedCountsBeyondEachStep) {
  Growth growth(Eigen::MatrixXd::Zero(2, 1));
  for (int k = 1; k <= 50; ++k) growth.after_a_step(Eigen::Vector2d(0.01 * k, 0));
  EXPECT_NEAR(growth.largest(), 1, 1e-12);
}

}  // namespace
}  // namespace lagroid::sensitivity_growth_tests
