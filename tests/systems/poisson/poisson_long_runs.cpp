// A million steps on Poisson manifolds: Casimirs go no further than rounding takes them, energies have no trend.
#include "poisson_recorded.hpp"

#include <gtest/gtest.h>

namespace lagroid::poisson_poisson_long_runs_tests {
namespace {

TEST(PoissonLongRuns, CasimirsGoByRoundingAloneAndEnergiesHaveNoTrend) {
  for (const Recorded& c : recorded()) {
    if (c.id.find("open") != std::string::npos) continue;  // its springs go to zero, and with them the motion
    const PoissonOptions options{.method = "symplectic-groupoid", .step = 0.05};
    const Drift found = drift(c, options, 1'000'000);
    EXPECT_LT(found.casimirs, 3e-11) << c.id;
    EXPECT_LT(found.energy_last, 1.2 * found.energy_first) << c.id;
  }
}

}  // namespace
}  // namespace lagroid::poisson_poisson_long_runs_tests
