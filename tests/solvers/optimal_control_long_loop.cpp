// Ten thousand samples of model predictive control: hours of a satellite that chance pushes about.
#include "../support/allocation_counter.hpp"
#include "satellite_loop.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lagroid::solvers_optimal_control_long_loop_tests {
namespace {

TEST(LongControlLoops, HardlyASampleTakesManyIterations) {
  constexpr long samples = 10000;
  ControlLoop<SatelliteTurn> loop(satellite_loop::turn(), 50);
  ASSERT_TRUE(loop.begin().converged());
  satellite_loop::Chance chance(0.003);
  std::vector<int> iterations(samples);
  const long before = allocation_count();
  long lost = 0;
  for (int& each : iterations) {
    const ControlReport report = loop.advance(loop.followed(chance()));
    lost += report.converged() ? 0 : 1;
    each = report.iterations;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(allocation_count() - before, 0);
  std::sort(iterations.begin(), iterations.end());
  EXPECT_LE(iterations[samples / 2], 6);
  EXPECT_LE(iterations[samples - samples / 1000], 20);
  // What docs/optimal_control_measured.md says.
  RecordProperty("samples", int(samples));
  for (const double percent : {50.0, 90.0, 99.0, 99.9, 100.0}) {
    const auto last = std::size_t(std::ceil(percent * double(samples) / 100 - 1e-9));
    RecordProperty(fmt::format("percentile {}", percent),
                   fmt::format("{} {:.17g}", iterations[last - 1], loop.latency().percentile(percent)));
  }
}

}  // namespace
}  // namespace lagroid::solvers_optimal_control_long_loop_tests
