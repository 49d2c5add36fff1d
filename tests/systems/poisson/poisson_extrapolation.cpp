// Extrapolation on the levels of energy and Casimirs: what it keeps, how errors grow, resuming, refusals.
#include "../../support/allocation_counter.hpp"

#include <lagroid/solvers/poisson/poisson_integrators.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/tops.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lagroid {

// Those are in the library; here are only the test's own.
LAGROID_POISSON_INTEGRATORS(extern template, HeavyTopBracket);
LAGROID_POISSON_INTEGRATORS(extern template, LotkaVolterra);
LAGROID_POISSON_INTEGRATORS(extern template, Sklyanin);
LAGROID_POISSON_INTEGRATORS(extern template, ThreeSpecies);

namespace poisson_extrapolation_tests {
namespace {

constexpr double period = 6.8170540474472894;  // of LotkaVolterra from (2, 1/2)
const Vector<double, 2> start(2, 0.5);

double distance_from_start(const PoissonIntegrator& motion) {
  const auto x = motion.point();
  return std::hypot(x[0] - start(0), x[1] - start(1));
}
/// How far from the start after so many periods.
double error_after(int periods, double tolerance) {
  const auto motion = make_poisson_integrator(LotkaVolterra(), start,
                                              {.method = "extrapolation", .step = period, .tolerance = tolerance});
  for (int k = 0; k < periods; ++k) EXPECT_TRUE(motion->advance().converged());
  return distance_from_start(*motion);
}

TEST(PoissonExtrapolation, FollowsItsTolerance) {
  EXPECT_LT(error_after(10, 1e-6), 1e-4);
  EXPECT_LT(error_after(10, 1e-9), 1e-7);
  EXPECT_LT(error_after(10, 1e-12), 1e-10);
}

TEST(PoissonExtrapolation, ErrorsGrowAsTimeDoesOnTheLevels) {
  const double short_run = error_after(100, 1e-7), long_run = error_after(1600, 1e-7);
  EXPECT_LT(long_run / short_run, 3 * 16);
}

/// The same field, without an energy that its steps could be taken back to.
struct Wandering : PoissonSystem<Wandering, 2> {
  template <class S> Matrix<S, 2, 2> bivector(const Vector<S, 2>& x) const { return LotkaVolterra().bivector(x); }
  template <class S> S hamiltonian(const Vector<S, 2>&) const { return S(1.0); }
  template <class S> Vector<S, 2> velocity(const Vector<S, 2>& x) const { return LotkaVolterra().velocity(x); }
};

TEST(PoissonExtrapolation, WithoutTheLevelsErrorsGrowAsTheSquareOfTime) {
  const auto after = [](int periods) {
    const auto motion =
        make_poisson_integrator(Wandering(), start, {.method = "extrapolation", .step = period, .tolerance = 1e-7});
    for (int k = 0; k < periods; ++k) EXPECT_TRUE(motion->advance().converged());
    return distance_from_start(*motion);
  };
  EXPECT_GT(after(1600) / after(100), 6 * 16);
}

TEST(PoissonExtrapolation, KeepsEnergyAndCasimirsToRounding) {
  const auto goes = [](const auto& system, const auto& begun) {
    using X = std::remove_cvref_t<decltype(begun)>;
    const auto motion =
        make_poisson_integrator(system, begun, {.method = "extrapolation", .step = 1, .tolerance = 1e-6});
    EXPECT_TRUE(motion->kept().energy);
    EXPECT_EQ(motion->kept().casimirs, 0);
    double largest = 0;
    for (int k = 0; k < 500; ++k) {
      EXPECT_TRUE(motion->advance().converged());
      const auto numbers = motion->point();
      const X x = Eigen::Map<const X>(numbers.data());
      largest = std::max(largest, std::abs(system.hamiltonian(x) - system.hamiltonian(begun)));
      if constexpr (casimir_count<std::remove_cvref_t<decltype(system)>>() > 0)
        largest = std::max(largest, (system.casimirs(x) - system.casimirs(begun)).cwiseAbs().maxCoeff());
    }
    return largest;
  };
  EXPECT_LT(goes(LotkaVolterra(), start), 2e-14);
  EXPECT_LT(goes(ThreeSpecies(), Vector<double, 3>(1, 1.9, 0.5)), 2e-14);
  EXPECT_LT(goes(Sklyanin(), Vector<double, 4>(0.7, 0.4, -0.5, 0.6)), 2e-14);
  Vector<double, 6> top;
  top << 0.3, 0.4, 1.2, 0, 0.6, 0.8;
  EXPECT_LT(goes(HeavyTopBracket(), top), 2e-14);
}

TEST(PoissonExtrapolation, ASteepEnergyIsKeptOrTheStepRefused) {
  // Near the axis, by a tolerance that knows nothing of the logarithm's.
  const LotkaVolterra system;
  const Vector<double, 2> begun(1e-9, 3);
  const auto motion =
      make_poisson_integrator(system, begun, {.method = "extrapolation", .step = 50, .tolerance = 1e-3});
  int nodes = 0;
  for (; nodes < 40 && motion->advance().converged(); ++nodes) {
    const auto x = motion->point();
    EXPECT_NEAR(system.hamiltonian(Vector<double, 2>(x[0], x[1])), system.hamiltonian(begun), 1e-13 * 25);
  }
  EXPECT_GT(nodes, 0);
}

TEST(PoissonExtrapolation, AtRelativeEquilibriaCasimirsAreKept) {
  // A top that stands: the energy's gradient is one of the Casimirs'.
  Vector<double, 6> asleep;
  asleep << 0, 0, 2, 0, 0, 1;
  const HeavyTopBracket top;
  const auto motion = make_poisson_integrator(top, asleep, {.method = "extrapolation", .step = 1, .tolerance = 1e-9});
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(motion->advance().converged());
  const auto x = motion->point();
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(x[i], asleep(Eigen::Index(i)), 1e-12);
}

TEST(PoissonExtrapolation, GoesOnWithTheSameBits) {
  const PoissonOptions options{.method = "extrapolation", .step = 0.7, .tolerance = 1e-10};
  const auto one = make_poisson_integrator(LotkaVolterra(), start, options);
  const auto other = make_poisson_integrator(LotkaVolterra(), start, options);
  one->go_on_from({1.5, 0.7});  // to other levels
  for (int k = 0; k < 10; ++k) one->advance();
  NumberArchive out;
  one->serialize(out);
  NumberArchive in(out.numbers());
  other->serialize(in);
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(one->advance().converged() && other->advance().converged());
    ASSERT_EQ(one->point(), other->point());
  }
}

TEST(PoissonExtrapolation, StepsAllocateNothing) {
  const auto motion =
      make_poisson_integrator(LotkaVolterra(), start, {.method = "extrapolation", .step = 1, .tolerance = 1e-10});
  motion->advance();
  const long before = allocation_count();
  for (int k = 0; k < 20; ++k) motion->advance();
  EXPECT_EQ(allocation_count(), before);
}

/// x' = x^2, y' = -2 x y.
struct Bursting : PoissonSystem<Bursting, 2> {
  template <class S> Matrix<S, 2, 2> bivector(const Vector<S, 2>&) const { return skew<S, 2>({{0, 1, S(1.0)}}); }
  template <class S> S hamiltonian(const Vector<S, 2>& x) const { return x(0) * x(0) * x(1); }
};

TEST(PoissonExtrapolation, FailsWhereItCannotGo) {
  EXPECT_THROW(make_poisson_integrator(LotkaVolterra(), start, {.method = "extrapolation", .step = -1}),
               std::invalid_argument);
  EXPECT_THROW(make_poisson_integrator(LotkaVolterra(), start, {.method = "extrapolation", .step = 1, .tolerance = 0}),
               std::invalid_argument);
  // x' = x^2, which is at infinity at t = 1.
  const auto motion = make_poisson_integrator(Bursting(), {1, 1}, {.method = "extrapolation", .step = 2});
  const auto before = motion->point();
  EXPECT_FALSE(motion->slope({}).allFinite());
  EXPECT_FALSE(motion->advance().converged());
  EXPECT_EQ(motion->point(), before);
}

}  // namespace
}  // namespace poisson_extrapolation_tests
}  // namespace lagroid
