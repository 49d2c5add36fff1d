// The satellite with rotors on pairs of (attitude, rotor angles), reduced by all of them.

#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>

#include "../../support/reduced_runs.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace reduction_reduced_satellite_tests {
namespace {

constexpr int steps = 1000;

/// The satellite of Gyrostat on pairs of (attitude, rotor angles).
struct SatelliteOnPairs : System<SatelliteOnPairs, PairOf<Gyrostat::GroupoidType>> {
  double h = 0.05;
  Gyrostat below;
  template <class A> auto lagrangian(const A& g) const { return below.lagrangian(groupoid.quotient(g), h); }
};

TEST(Reduction, OfTheSatelliteWithRotorsIsTheGyrostat) {
  const SatelliteOnPairs full;
  const auto e = full.groupoid.group.unit(ObjectOf<Gyrostat::GroupoidType>{});
  const auto arrows = arrows_about(full.groupoid, e);
  const auto reduced = reduce<LeftQuotient<Gyrostat::GroupoidType>>({}, full, arrows);
  Vector<double, 6> momentum;
  momentum << 1.2, 0.3, -0.5, 0.2, -0.1, 0.3;
  const auto start = full.groupoid.tau(e, Vector<double, 6>(0.3, 0.1, 0.8, 1, 2, -1));
  Gyrostat gyrostat;
  gyrostat.h = full.h;
  EXPECT_TRUE(agree(run_side_by_side(reduced, gyrostat, start, momentum, steps)));
}

}  // namespace
}  // namespace reduction_reduced_satellite_tests
