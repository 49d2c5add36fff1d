// Kepler by its angle, the gyrostat by its rotors.

#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/polar.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>

#include "../../support/level_runs.hpp"

using namespace lagroid;

namespace {

constexpr int steps = 1000;
using PolarKepler = ReducedSystem<PolarQuotient, Kepler>;
using ByTheAngle = FactorConnection<Factors<1>, Pair<1>, SO2>;

State<PolarKepler::GroupoidType> start() { return {{Vector<double, 1>(1.1), {}}, Vector<double, 2>(0.3, 0.9)}; }
PolarKepler polar_kepler() {
  PolarKepler polar;
  polar.h = 0.02;
  return polar;
}

TEST(MomentumLevel, OfThePlanarKeplerProblemLeavesTheRadius) {
  const auto level = level_through(ByTheAngle{}, polar_kepler(), start());
  EXPECT_EQ(level.level(0), 0.9);
  EXPECT_TRUE(agree(run_level_beside(level, start(), steps)));
}

TEST(MomentumLevel, HasTheAmendedPotential) {
  // R(r, r) / h = -V(r) - level^2 / (2 r^2) + O(h^2).
  const auto polar = polar_kepler();
  const MomentumLevel<ByTheAngle, PolarKepler> level({}, polar, Vector<double, 1>(0.9));
  const Vector<double, 1> r(1.3);
  EXPECT_NEAR(level.lagrangian(PairArrow<double, 1>{r, r}) / polar.h, 1 / 1.3 - 0.81 / (2 * 1.3 * 1.3), 1e-4);
}

TEST(BrokenMomentumLevel, OfAnotherMomentumIsSeen) {
  auto level = level_through(ByTheAngle{}, polar_kepler(), start());
  level.level(0) += 1e-6;
  EXPECT_FALSE(agree(run_level_beside(level, start(), 20)));
}

TEST(MomentumLevel, RefusesToStartWhereRotationsAreNotFree) {
  const ReducedSystem<PolarQuotient, Kepler> reduced;
  EXPECT_THROW(reduced.state_below({Vector<double, 2>(0, 0), Vector<double, 2>(1, 0)}), NotFree);
  EXPECT_NO_THROW(reduced.state_below({Vector<double, 2>(0, 0.1), Vector<double, 2>(1, 0)}));
}

TEST(MomentumLevel, WithoutACriticalPointIsNotANumber) {
  // r0 r1 sin(theta) = h level has no root.
  const MomentumLevel<ByTheAngle, PolarKepler> level({}, polar_kepler(), Vector<double, 1>(100));
  const Vector<double, 1> r(0.5);
  EXPECT_TRUE(std::isnan(level.lagrangian(PairArrow<double, 1>{r, r})));
}

TEST(MomentumLevel, OfTheGyrostatLeavesTheBody) {
  Gyrostat full;
  full.h = 0.05;
  State<Gyrostat::GroupoidType> z{{}, {}};
  z.momentum << 1.2, 0.3, -0.5, 0.2, -0.1, 0.3;
  const auto level = level_through(FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2>{}, full, z);
  EXPECT_TRUE(level.level.isApprox(z.momentum.tail<3>(), 1e-15));
  EXPECT_TRUE(agree(run_level_beside(level, z, steps)));
}

}  // namespace
