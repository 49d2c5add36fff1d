// Noise on Poisson manifolds, from many paths: orders, a million steps of the top, the thermostat extrapolated in h.
#include "noise_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace lagroid::poisson_poisson_noise_long_tests {
namespace {

using X3 = Vector<double, 3>;
const X3 start{0.8, 0.6, 1.1};

TEST(PoissonNoiseLong, OrdersAreThoseOfTheTheoryWithinTwoStandardErrors) {
  const NoiseOrders found = noise_orders(200, 2);
  expect_order("strong, the noise is the energy's: 1", found.commuting, 1, 0.01);
  expect_order("strong, one noise: 1", found.one, 1, 0.02);
  expect_order("strong, three noises: 1/2", found.several, 0.5, 0.02);
  expect_order("weak, three noises: 1", found.weak, 1, 0.08);
}

TEST(PoissonNoiseLong, TheMomentumOfAStochasticTopKeepsItsSizeOverAMillionSteps) {
  for (const double temperature : {0.0, 0.5}) {
    const auto motion = make_poisson_integrator(
        EulerTop{}, start,
        {.step = 0.05, .noise = {.strength = {0.5, 0.5, 0.5}, .seed = 1, .temperature = temperature}});
    double largest = 0;
    for (long k = 0; k < 1'000'000; ++k) {
      ASSERT_TRUE(motion->advance().converged());
      const std::vector<double> m = motion->point();
      largest = std::max(largest, std::abs(X3(m[0], m[1], m[2]).norm() - start.norm()));
    }
    EXPECT_LT(largest, 5e-12) << temperature;
    RecordProperty("drift", std::to_string(largest * 1e12) + "e-12");
  }
}

TEST(PoissonNoiseLong, TheThermostatExtrapolatedHasGibbsMeasureWithinThreeStandardErrors) {
  const EulerTop top;
  const double temperature = 0.5;
  const auto energy = [&](const auto& m) { return top.hamiltonian(X3(m[0], m[1], m[2])); };
  const auto third = [](const auto& m) { return m[2] * m[2]; };
  const auto found = [&](double h, const auto& f) {
    return time_mean(
        [&](std::uint32_t path) {
          return make_poisson_integrator(
              top, start,
              {.step = h,
               .noise = {.strength = {1, 1, 1}, .seed = h > 0.3 ? 5U : 6U, .path = path, .temperature = temperature}});
        },
        40, std::lround(20'000 / h), f);
  };
  const auto asked = [&](const auto& f, bool sees_steps) {
    const double exact = gibbs_mean(top, start.norm(), temperature, f);
    const Estimate coarse = found(0.4, f);
    const Estimate fine = found(0.2, f);
    const double limit = 2 * fine.value - coarse.value;
    const double error = std::hypot(2 * fine.error, coarse.error);
    EXPECT_NEAR(limit, exact, 3 * error);
    if (sees_steps) {
      EXPECT_GT(std::abs(coarse.value - exact), 4 * coarse.error);
    }
  };
  asked(energy, true);
  asked(third, false);
}

}  // namespace
}  // namespace lagroid::poisson_poisson_noise_long_tests
