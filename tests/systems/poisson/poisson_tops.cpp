// Tops on se(3)* and T*SO(3): reduction from above, attitudes that noise drives, and the measure of their thermostat.
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/systems/poisson/from_above.hpp>
#include <lagroid/systems/poisson/noise_study.hpp>
#include <lagroid/systems/poisson/spins.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace lagroid::poisson_poisson_tops_tests {
namespace {

using X6 = Vector<double, 6>;
using X12 = Vector<double, 12>;

/// The momentum and the rows of an attitude.
X12 body_at(const Vector<double, 3>& momentum, const Matrix<double, 3, 3>& attitude) {
  X12 x;
  x << momentum, attitude.row(0).transpose(), attitude.row(1).transpose(), attitude.row(2).transpose();
  return x;
}
Matrix<double, 3, 3> attitude_of(const std::vector<double>& x) {
  Matrix<double, 3, 3> attitude;
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < 3; ++i) attitude(a, i) = x[std::size_t(3 + 3 * a + i)];
  return attitude;
}
const Vector<double, 3> momentum{0.8, 0.6, 1.1};
const Matrix<double, 3, 3> turned = SO3::exp(Vector<double, 3>(0.3, 0.5, -0.2));

BodyInSpace pendulous() {
  BodyInSpace body;
  body.inertia = {1, 1.3, 0.6};
  body.weight = {0.1, -0.2, 0.9};
  return body;
}

TEST(ReductionFromAbove, BothWaysAgreeToRoundOff) {
  const auto found = reductions_from_above(200);
  EXPECT_EQ(found.size(), 4U);
  for (const FromAbove& each : found)
    EXPECT_LT(each.largest, 2e-13) << each.above << " beside " << each.bracket;  // a top's motion grows tenfold
}

TEST(ReductionFromAbove, AnotherMapFromTheAlgebraIsSeen) {
  RigidBody body;
  body.h = 0.05;
  FromAbove found;
  detail::compare_from_above(
      found, 200,
      detail::steps_above<RigidBody>(body, {{}, momentum}, [](const auto& s) { return Eigen::VectorXd(s.momentum); }),
      detail::steps_below(EulerTop(), momentum, {.method = "symplectic-groupoid", .step = 0.05}));
  EXPECT_GT(found.largest, 1e-4);
}

TEST(ReductionFromAbove, TheBodyInSpaceReducesToTheHeavyTop) {
  const BodyInSpace body = pendulous();
  HeavyTopBracket top;
  top.inertia = body.inertia;
  top.weight = body.weight;
  X6 start;
  start << momentum, turned.row(2).transpose();
  for (const char* method : {"symplectic-groupoid", "karasev", "hamilton-jacobi-4", "splitting"}) {
    const auto above = make_poisson_integrator(body, body_at(momentum, turned), {.method = method, .step = 0.05});
    const auto below = make_poisson_integrator(top, start, {.method = method, .step = 0.05});
    for (int k = 0; k < 100; ++k) ASSERT_TRUE(above->advance().converged() && below->advance().converged()) << method;
    const auto x = above->point(), y = below->point();
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(x[i], y[i], 1e-12) << method;
      EXPECT_NEAR(x[9 + i], y[3 + i], 1e-12) << method;
    }
  }
}

TEST(BodyInSpaceUnderNoise, ItsAttitudeStaysARotation) {
  for (const double temperature : {0.0, 0.5}) {
    PoissonOptions options{.step = 0.05};
    options.noise = {.strength = std::vector<double>(12, 0.3), .seed = 4, .temperature = temperature};
    const auto motion = make_poisson_integrator(pendulous(), body_at(momentum, turned), options);
    for (int k = 0; k < 2000; ++k) ASSERT_TRUE(motion->advance().converged());
    const Matrix<double, 3, 3> attitude = attitude_of(motion->point());
    EXPECT_LT((attitude * attitude.transpose() - Matrix<double, 3, 3>::Identity()).cwiseAbs().maxCoeff(), 2e-13);
    EXPECT_NEAR(attitude.determinant(), 1, 2e-13);
    if (temperature == 0) {
      EXPECT_LT(motion->poisson_defect(), 1e-14);
    }
  }
}

/// The means of R33 and of M_i^2 / I_i over a run in a bath, with standard errors of means over parts of it.
struct InBath {
  Estimate height;
  Estimate energy;
};
InBath in_bath(double temperature) {
  BodyInSpace body = pendulous();
  body.weight = {0, 0, 1};
  PoissonOptions options{.step = 0.04};
  // Torques of R_ij along all axes alike, whatever the attitude: their squares add up to twice the identity.
  std::vector<double> strength(12, 0.8);
  strength[0] = strength[1] = strength[2] = 0;
  options.noise = {.strength = strength, .seed = 11, .temperature = temperature};
  const auto motion =
      make_poisson_integrator(body, body_at({0, 0, 0}, SO3::exp(Vector<double, 3>(2.6, 0, 0))), options);
  std::vector<double> heights, energies;
  for (int part = 0; part < 40; ++part) {
    double height = 0, energy = 0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      if (!motion->advance().converged()) throw std::runtime_error("a step in the bath did not converge");
      const auto x = motion->point();
      height += x[11] / steps;
      for (int i = 0; i < 3; ++i) energy += x[std::size_t(i)] * x[std::size_t(i)] / body.inertia(i) / (3.0 * steps);
    }
    heights.push_back(height);
    energies.push_back(energy);
  }
  return {estimate(heights), estimate(energies)};
}

TEST(BodyInSpaceUnderNoise, ItsThermostatHasGibbsMeasure) {
  constexpr double temperature = 0.5;
  const InBath found = in_bath(temperature);
  // Langevin's function of weight over temperature; equipartition.
  const double height = 1 / (1 / temperature) - 1 / std::tanh(1 / temperature);
  EXPECT_NEAR(found.height.value, height, 3 * found.height.error + 5e-3);
  EXPECT_NEAR(found.energy.value, temperature, 3 * found.energy.error + 5e-3);
  EXPECT_LT(found.height.error, 0.02);
  EXPECT_LT(found.energy.error, 0.02);
  // At another temperature neither.
  EXPECT_GT(std::abs(found.energy.value - 0.6), 5 * found.energy.error);
}

TEST(SpinChainUnderNoise, EachSpinKeepsItsLength) {
  PoissonOptions options{.step = 0.05};
  options.noise = {.strength = std::vector<double>(9, 0.4), .seed = 2, .temperature = 0.7};
  Vector<double, 9> start;
  start << 1, 0, 0, 0, 1, 0, 0.6, 0, 0.8;
  const auto motion = make_poisson_integrator(SpinChain<3>(), start, options);
  for (int k = 0; k < 2000; ++k) ASSERT_TRUE(motion->advance().converged());
  const auto x = motion->point();
  for (std::size_t i = 0; i < 9; i += 3) EXPECT_NEAR(x[i] * x[i] + x[i + 1] * x[i + 1] + x[i + 2] * x[i + 2], 1, 2e-13);
}

TEST(StochasticTop, AProjectedStepEndsOnTheCasimirsOfTheStart) {
  const auto off = [](bool project) {
    PoissonOptions options{.step = 0.05};
    options.noise = {.strength = std::vector<double>(3, 0.4), .seed = 2, .project = project};
    const auto motion = make_poisson_integrator(EulerTop(), momentum, options);
    double largest = 0;
    for (int k = 0; k < 20000; ++k) {
      EXPECT_TRUE(motion->advance().converged());
      const auto x = motion->point();
      largest = std::max(largest, std::abs(std::hypot(x[0], x[1], x[2]) / momentum.norm() - 1));
    }
    return largest;
  };
  EXPECT_LT(off(true), 1e-15);
  EXPECT_GT(off(false), 5e-15);
}

TEST(SpinChain, IsTheEquationOfLandauAndLifshitz) {
  SpinChain<2> chain;
  chain.anisotropy = 1.4;
  const Vector<double, 3> one(0.3, -0.2, 0.5), two(0.1, 0.6, -0.4);
  Vector<double, 6> x;
  x << one, two;
  const Vector<double, 3> field(-two(0), -two(1), -1.4 * two(2) - 0.5);  // dH / dS_1
  EXPECT_LT((chain.velocity(x).head<3>() - one.cross(field)).norm(), 1e-15);
}

}  // namespace
}  // namespace lagroid::poisson_poisson_tops_tests
