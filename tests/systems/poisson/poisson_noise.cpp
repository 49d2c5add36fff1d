// Noise on Poisson manifolds: orders, what is kept path by path, the thermostat's measure, streams.
#include "../../support/allocation_counter.hpp"
#include "noise_runs.hpp"

#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::poisson_poisson_noise_tests {
namespace {

using X3 = Vector<double, 3>;
const X3 start{0.8, 0.6, 1.1};

PoissonOptions isotropic(double step, double strength, NoiseOptions noise = {}) {
  noise.strength = {strength, strength, strength};
  return {.step = step, .noise = noise};
}

TEST(WienerPath, IsPhiloxAndTheTransformationOfBoxAndMuller) {
  // By an implementation in Python, which has the test vectors that the generator's authors give.
  const auto near = [](const std::array<double, 2>& found, double first, double second) {
    EXPECT_NEAR(found[0], first, 4e-15);
    EXPECT_NEAR(found[1], second, 4e-15);
  };
  near(WienerPath{1, 0}.normals(0, 0), -0.11368019704496955, -0.45786963520401447);
  near(WienerPath{1, 0}.normals(0, 1), 2.0056205499002466, 0.51408799166338381);
  near(WienerPath{1, 0}.normals(1, 0), -0.28859563518898057, -0.43105247686471793);
  near(WienerPath{1, 1}.normals(0, 0), -1.4778786447594823, 0.71522342310350684);
  near(WienerPath{2, 0}.normals(0, 0), -0.95409422848496728, 0.69778777586961516);
  near(WienerPath{4886718345, 7}.normals(68719476738, 1), -0.72228661216256684, -0.74482244134739417);
}

TEST(WienerPath, HasTheMomentsOfIndependentNormalNumbers) {
  constexpr int n = 200'000;
  double mean = 0;
  double square = 0;
  double fourth = 0;
  double next_step = 0;
  double next_path = 0;
  double other_process = 0;
  double next_seed = 0;
  for (int k = 0; k < n; ++k) {
    const auto xi = WienerPath{3, 5}.normals(k, 0);
    mean += xi[0] / n;
    square += xi[0] * xi[0] / n;
    fourth += std::pow(xi[0], 4) / n;
    next_step += xi[0] * WienerPath{3, 5}.normals(k + 1, 0)[0] / n;
    next_path += xi[0] * WienerPath{3, 6}.normals(k, 0)[0] / n;
    next_seed += xi[0] * WienerPath{4, 5}.normals(k, 0)[0] / n;
    other_process += xi[0] * xi[1] / n;
  }
  const double sigma = 1 / std::sqrt(double(n));
  for (const double zero : {mean, next_step, next_path, next_seed, other_process}) EXPECT_LT(std::abs(zero), 4 * sigma);
  EXPECT_NEAR(square, 1, 4 * std::sqrt(2.0) * sigma);
  EXPECT_NEAR(fourth, 3, 4 * std::sqrt(96.0) * sigma);
}

TEST(PoissonNoise, HasItsOrdersWithinTwoStandardErrors) {
  const NoiseOrders found = noise_orders(40);
  expect_order("strong, the noise is the energy's: 1", found.commuting, 1, 0.05);
  expect_order("strong, one noise: 1", found.one, 1, 0.05);
  expect_order("strong, three noises: 1/2", found.several, 0.5, 0.05);
  expect_order("weak, three noises: 1", found.weak, 1, 0.15);
}

/// With p where the step begins: a step of Ito's equation or of none, and not of Stratonovich's.
struct HastyStep {
  CayleyChart<EulerTop> chart;
  StepReport take(const X3& x, double h, const Vector<double, 1>& dw, X3& end) {
    end = chart.from(x, X3(chart.system.gradient(x) * (h + 0.5 * dw(0)))).end;
    return {SolveStatus::converged, 1, 0, 0};
  }
};
TEST(PoissonNoise, AStepWithItsMomentumFromTheBeginningConvergesToAnotherEquation) {
  const auto right = groupoid_noise(ShakenTop{}, Vector<double, 1>(0.5));
  double apart = 0;
  double near = 0;
  for (std::uint32_t m = 0; m < 20; ++m) {
    const Refined<1> path({.seed = 11, .path = m}, 1, 10);
    const X3 end = end_of(right, start, path, 10);
    near = std::max(near, (end_of(right, start, path, 9) - end).norm());
    apart = std::max(apart, (end_of(HastyStep{}, start, path, 10) - end).norm());
  }
  EXPECT_LT(near, 0.01);
  EXPECT_GT(apart, 0.05);
}

/// Linear Hamiltonians: the mean solves a linear equation, and that of a step is a matrix.
struct Spun : PoissonSystem<Spun, 3> {
  static constexpr double rotation_sign = 1;
  template <class S> Matrix<S, 3, 3> bivector(const Vector<S, 3>& m) const { return EulerTop{}.bivector(m); }
  template <class S> S hamiltonian(const Vector<S, 3>& m) const { return m(0) * 0.4 + m(1) * 0.9 - m(2) * 0.3; }
  static constexpr std::array<std::string_view, 3> noise_names{"M1", "M2", "M3"};
  template <class S> S noise(int k, const Vector<S, 3>& m) const { return m(k); }
};
TEST(PoissonNoise, MeansHaveOrderOneByQuadrature) {
  // Nodes and weights of Gauss and Hermite, by the eigenvalues of the recurrence.
  constexpr int n = 10;
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(n, n);
  for (int i = 1; i < n; ++i) recurrence(i, i - 1) = recurrence(i - 1, i) = std::sqrt(double(i));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of(recurrence);
  using Square = Matrix<double, 3, 3>;
  const X3 strength(0.8, 0.5, 0.3);
  const auto turn = [](const X3& w) {  // M -> M x w
    return Square{{0, w(2), -w(1)}, {-w(2), 0, w(0)}, {w(1), -w(0), 0}};
  };
  Square generator = turn({0.4, 0.9, -0.3});
  for (int k = 0; k < 3; ++k) {
    const Square a = turn(X3(X3::Unit(k) * strength(k)));
    generator += 0.5 * a * a;
  }
  Square exact = Square::Identity();
  for (int k = 30; k > 0; --k) exact = Square::Identity() + generator * exact / k;
  const auto step = groupoid_noise(Spun{}, strength);
  std::vector<double> errors;
  for (int steps = 8; steps <= 128; steps *= 2) {
    const double h = 1.0 / steps;
    Square mean = Square::Zero();
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int c = 0; c < n; ++c) {
          const X3 dw = std::sqrt(h) * X3(of.eigenvalues()(a), of.eigenvalues()(b), of.eigenvalues()(c));
          const double w = std::pow(of.eigenvectors()(0, a) * of.eigenvectors()(0, b) * of.eigenvectors()(0, c), 2);
          for (int i = 0; i < 3; ++i) {
            X3 end;
            auto each = step;
            ASSERT_TRUE(each.take(X3(X3::Unit(i)), h, dw, end).converged());
            mean.col(i) += w * end;
          }
        }
    Square power = Square::Identity();
    for (int k = 0; k < steps; ++k) power = (mean * power).eval();
    errors.push_back((power - exact).norm());
  }
  const std::size_t last = errors.size() - 1;
  EXPECT_NEAR(std::log2(errors[last - 1] / errors[last]), 1, 0.02);
  EXPECT_LT(errors[last], 0.01);
}

TEST(PoissonNoise, CasimirsAreKeptPathByPath) {
  const auto drift = [](const PoissonOptions& options) {
    const auto motion = make_poisson_integrator(EulerTop{}, start, options);
    const double r = start.norm();
    double largest = 0;
    for (int k = 0; k < 20'000; ++k) {
      EXPECT_TRUE(motion->advance().converged());
      const std::vector<double> m = motion->point();
      largest = std::max(largest, std::abs(X3(m[0], m[1], m[2]).norm() / r - 1));
    }
    return largest;
  };
  EXPECT_LT(drift(isotropic(0.05, 0.5)), 6e-13);
  EXPECT_LT(drift(isotropic(0.05, 0.5, {.temperature = 0.5})), 6e-13);
  PoissonOptions karasev = isotropic(0.05, 0.5, {.seed = 2});
  karasev.method = "karasev";
  EXPECT_LT(drift(karasev), 6e-13);
}
TEST(PoissonNoise, TheExplicitRuleOfHeunLosesThem) {
  const EulerTop top;
  X3 m = start;
  for (int k = 0; k < 2000; ++k) {
    const X3 dw = WienerPath{1}.increments<3>(k, 0.05);
    const auto rate = [&](const X3& x) { return X3(top.field(x, X3(0.05 * top.gradient(x) + 0.5 * dw))); };
    const X3 first = rate(m);
    m += 0.5 * (first + rate(m + first));
  }
  EXPECT_GT(std::abs(m.norm() / start.norm() - 1), 1e-3);
}

TEST(PoissonNoise, StepsArePoissonMapsUnlessThereIsFriction) {
  const auto defect = [](const auto& system, const auto& x, const PoissonOptions& options) {
    const auto motion = make_poisson_integrator(system, x, options);
    double largest = 0;
    for (int k = 0; k < 20; ++k) {
      largest = std::max(largest, motion->poisson_defect());
      EXPECT_TRUE(motion->advance().converged());
    }
    return largest;
  };
  const PoissonOptions shaken = isotropic(0.05, 0.5);
  EXPECT_LT(defect(EulerTop{}, start, shaken), 1e-13);
  EXPECT_LT(defect(MagneticParticle{}, Vector<double, 6>(0.5, 0.2, -0.3, 0.4, 0.1, 0.3), shaken), 1e-13);
  const PoissonOptions seasons{.step = 0.05, .noise = {.strength = {0.2, 0.1}}};
  EXPECT_LT(defect(LotkaVolterra{}, Vector<double, 2>(2, 0.5), seasons), 1e-13);
  PoissonOptions midpoint = seasons;
  midpoint.method = "midpoint";
  EXPECT_GT(defect(LotkaVolterra{}, Vector<double, 2>(2, 0.5), midpoint), 1e-7);
  const PoissonOptions damped = isotropic(0.05, 0.5, {.temperature = 0.5});
  EXPECT_GT(defect(EulerTop{}, start, damped), 1e-4);
  const auto kept = [](const PoissonOptions& options) {
    return make_poisson_integrator(EulerTop{}, start, options)->kept();
  };
  EXPECT_EQ(kept(shaken).bracket, 0);
  EXPECT_EQ(kept(damped).bracket, 1);
  EXPECT_EQ(kept(damped).casimirs, 0);
}

TEST(PoissonNoise, TheThermostatOfAParticleIsLangevins) {
  // Energies of k x_i^2 / 2 and v_i^2 / 2 are T / 2 each, in any magnetic field. T and the friction s^2 / 2T are such
  // that the bias of the step is below the standard error.
  MagneticParticle trapped;
  trapped.stiffness = 2;
  const double temperature = 0.3;
  const auto begin = [&](std::uint32_t path) {
    return make_poisson_integrator(trapped, Vector<double, 6>(0.5, 0.2, -0.3, 0.4, 0.1, 0.3),
                                   isotropic(0.1, 0.8, {.seed = 6, .path = path, .temperature = temperature}));
  };
  const Estimate spring =
      time_mean(begin, 20, 3000, [](const auto& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; });
  const Estimate motion =
      time_mean(begin, 20, 3000, [](const auto& x) { return x[3] * x[3] + x[4] * x[4] + x[5] * x[5]; });
  EXPECT_NEAR(spring.value, 3 * temperature / trapped.stiffness, 3 * spring.error);
  EXPECT_NEAR(motion.value, 3 * temperature, 3 * motion.error);
  EXPECT_LT(motion.error, 0.03);
}

TEST(PoissonNoise, TheThermostatOfATopHasGibbsMeasure) {
  const EulerTop top;
  const double temperature = 0.5;
  const auto energy = [&](const auto& m) { return top.hamiltonian(X3(m[0], m[1], m[2])); };
  const Estimate found = time_mean(
      [&](std::uint32_t path) {
        return make_poisson_integrator(top, start,
                                       isotropic(0.1, 1, {.seed = 5, .path = path, .temperature = temperature}));
      },
      40, 10'000, energy);
  EXPECT_NEAR(found.value, gibbs_mean(top, start.norm(), temperature, energy), 3 * found.error);
  // Another temperature is seen.
  EXPECT_GT(std::abs(found.value - gibbs_mean(top, start.norm(), 1.1 * temperature, energy)), 4 * found.error);
}

TEST(PoissonNoise, WithoutStrengthItIsTheFreeMotion) {
  const auto shaken = make_poisson_integrator(EulerTop{}, start, isotropic(0.05, 0));
  const auto free = make_poisson_integrator(EulerTop{}, start, {.step = 0.05});
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(shaken->advance().converged());
    ASSERT_TRUE(free->advance().converged());
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shaken->point()[i], free->point()[i], 1e-13);
}

TEST(PoissonNoise, APathGoesOnWithTheSameBits) {
  const PoissonOptions options = isotropic(0.05, 0.5, {.seed = 9, .path = 4, .temperature = 0.5});
  const auto whole = make_poisson_integrator(EulerTop{}, start, options);
  for (int k = 0; k < 30; ++k) whole->advance();
  NumberArchive written;
  whole->serialize(written);
  const auto resumed = make_poisson_integrator(EulerTop{}, {1, 0, 0}, options);
  NumberArchive read(written.numbers());
  resumed->serialize(read);
  PoissonOptions other_path = options;
  other_path.noise.path = 5;
  const auto other = make_poisson_integrator(EulerTop{}, start, other_path);
  for (int k = 0; k < 30; ++k) {
    whole->advance();
    other->advance();  // a path between does not matter
    other->poisson_defect();
    resumed->advance();
  }
  EXPECT_EQ(whole->point(), resumed->point());
  EXPECT_EQ(whole->time(), resumed->time());
  EXPECT_NE(whole->point(), other->point());
}

TEST(PoissonNoise, StepsAllocateNothing) {
  const auto motion = make_poisson_integrator(EulerTop{}, start, isotropic(0.05, 0.5, {.temperature = 0.5}));
  motion->advance();
  const auto before = allocation_count();
  for (int k = 0; k < 10; ++k) motion->advance();
  EXPECT_EQ(allocation_count(), before);
}

TEST(PoissonNoise, WhatCannotBeIsRefused) {
  const auto refused = [](const PoissonOptions& options) {
    EXPECT_THROW(make_poisson_integrator(EulerTop{}, start, options), std::invalid_argument);
  };
  refused({.noise = {.strength = {0.1}}});
  refused(isotropic(0.05, -0.1));
  refused(isotropic(0.05, std::numeric_limits<double>::infinity()));
  refused(isotropic(-0.05, 0.1));
  refused(isotropic(0.05, 0.1, {.temperature = -1}));
  PoissonOptions fourth = isotropic(0.05, 0.1);
  fourth.method = "hamilton-jacobi-4";
  refused(fourth);
  PoissonOptions composed = isotropic(0.05, 0.1);
  composed.composition = compositions::suzuki;
  refused(composed);
  EXPECT_THROW(make_poisson_integrator(MaxwellBloch{}, start, isotropic(0.05, 0.1)), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::poisson_poisson_noise_tests
