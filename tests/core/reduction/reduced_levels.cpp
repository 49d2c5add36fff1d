// Kepler by its angle, the gyrostat by its rotors.

#include <lagroid/core/reduction/reconstruction.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/polar.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>

#include "../../support/level_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_levels_tests {
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

TEST(MomentumLevel, AdmitsNoStepToWhereRotationsAreNotFree) {
  const auto level = level_through(ByTheAngle{}, polar_kepler(), start());
  const Vector<double, 1> r(0.5);
  EXPECT_TRUE(level.admissible({r, r}));
  EXPECT_FALSE(level.admissible({r, Vector<double, 1>(0)}));
}

TEST(MomentumLevel, WithoutACriticalPointIsNotANumber) {
  // r0 r1 sin(theta) = h level has no root.
  const MomentumLevel<ByTheAngle, PolarKepler> level({}, polar_kepler(), Vector<double, 1>(100));
  const Vector<double, 1> r(0.5);
  EXPECT_TRUE(std::isnan(level.lagrangian(PairArrow<double, 1>{r, r})));
  EXPECT_TRUE(std::isnan(level.routhian_by_solving(PairArrow<double, 1>{r, r})));
}

/// A claimed Routhian, that of twice the attraction.
struct Mistaken : System<Mistaken, Pair<2>> {
  Kepler planet;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return planet.lagrangian(g); }
  template <class S, class T>
  S routhian(const ByTheAngle& by, const PairArrow<S, 1>& b, const Vector<T, 1>& momentum) const {
    Kepler other = planet;
    other.strength *= 2;
    return other.routhian(by, b, momentum);
  }
};
template <class Sys> DescentReport examined(const Sys& system) {
  const auto declared = fixed_momentum("angular-momentum", PolarQuotient{}, ByTheAngle{}, "the radius alone moves");
  const State<Pair<2>> z{{1.1, 0.2}, {-0.1, 0.9}};
  const Reconstruction<Sys, std::remove_const_t<decltype(declared)>> down(declared, system, z,
                                                                          system.groupoid.unit(z.object));
  return down.examine(arrows_about(system.groupoid, z.object));
}
TEST(MomentumLevel, RefusesAClosedFormThatIsAnother) {
  const DescentReport found = examined(Mistaken{});
  ASSERT_FALSE(found.descends());
  EXPECT_EQ(found.worst()->ingredient, Ingredient::routhian);
  EXPECT_FALSE(found.worst()->sample.empty());
  EXPECT_NE(found.sentence().find("the Routhian is not that of the Lagrangian: at the arrow ("), std::string::npos)
      << found.sentence();
  EXPECT_TRUE(examined(Kepler{}).descends());
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

TEST(MomentumLevel, OfAWheelThatTurnsHalfRoundInAStepIsNotANumber) {
  Gyrostat full;
  full.h = 0.05;
  const MomentumLevel of_slow(Gyrostat::ByTheRotors{}, full, Vector<double, 3>(20, 0, 0));
  const MomentumLevel of_fast(Gyrostat::ByTheRotors{}, full, Vector<double, 3>(30, 0, 0));
  const Matrix<double, 3, 3> still = Matrix<double, 3, 3>::Identity();
  EXPECT_NEAR(of_slow.angle_of(still, of_slow.level)(0), 2.5, 1e-14);
  EXPECT_TRUE(std::isnan(of_fast.lagrangian(still)));
}

}  // namespace
}  // namespace reduction_reduced_levels_tests
