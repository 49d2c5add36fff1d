// Over a million steps the energy of symplectic methods has no slope, and that of Runge-Kutta has.

#include <lagroid/run/study/measure.hpp>
#include <study/scene_experiment.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace lagroid;
using namespace lagroid::app;

namespace run_energy_drift_tests {
namespace {

struct LongRun {
  const char* scene;
  double step;
};

class EnergyDrift : public ::testing::TestWithParam<LongRun> {};

/// The slope, over the whole run, is a ten-thousandth of the oscillation of the energy, or its standard error, or what
/// rounding gives to sums of so many terms, each of the size of the energy: a random walk of a few units per step.
TEST_P(EnergyDrift, HasNoSlopeOverAMillionSteps) {
  constexpr double steps = 1e6;
  Experiment experiment =
      read_experiment(read_scene(std::string(LAGROID_EXAMPLES) + "/" + GetParam().scene + ".toml", {"time.steps=10"}));
  const double walk = 20 * std::numeric_limits<double>::epsilon() * std::sqrt(steps);
  int drifting = 0;
  int judged = 0;
  for (const Method& method : experiment.methods) {
    if (!method.equal_steps) continue;
    // The drift of Runge-Kutta steps is a slope as long as it is small.
    const double h = GetParam().step * (method.to_compare ? 0.25 : std::sqrt(double(method.stages)));
#ifdef LAGROID_WHOLE_STEPS
    experiment.end = steps * h;
#else
    experiment.end = steps / method.stages * h;  // a million stages, of composed steps
#endif
    const Measurement m = measure_once(experiment, method, h, nullptr, 1e9);
    if (!m.converged() && method.to_compare) {  // away from the constraint, until numbers end
      EXPECT_FALSE(m.invariants < 0.1) << method.name;
      ++drifting;
      continue;
    }
    ASSERT_TRUE(m.converged()) << method.name << ' ' << m.status << ' ' << m.message;
    const double slope = std::abs(m.drift);
    const bool flat = slope < 4 * m.drift_error + 1e-4 * m.invariants + walk && slope < 0.05 * m.invariants + walk;
    RecordProperty(method.name, std::to_string(m.drift));
    if (method.to_compare) {
      drifting += flat ? 0 : 1;
      EXPECT_GT(slope, 10 * m.drift_error) << method.name;
    } else {
      ++judged;
      EXPECT_TRUE(flat) << method.name << ": slope times time " << m.drift << " +- " << m.drift_error << ", amplitude "
                        << m.invariants << ", rounding " << walk;
    }
  }
  EXPECT_EQ(drifting, 1) << "the test sees a drift where there is one";
  EXPECT_GE(judged, 6);
}

INSTANTIATE_TEST_SUITE_P(Systems, EnergyDrift,
                         ::testing::Values(LongRun{"kepler", 0.05}, LongRun{"pendulum", 0.1},
                                           LongRun{"rigid_body", 0.1}, LongRun{"heavy_top", 0.05},
                                           LongRun{"spherical_pendulum", 0.04}),
                         [](const auto& run) { return std::string(run.param.scene); });

}  // namespace
}  // namespace run_energy_drift_tests
