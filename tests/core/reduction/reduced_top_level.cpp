// The heavy top at a fixed momentum about the vertical: a system on pairs of directions, with a magnetic term.

#include <lagroid/groupoids/connections.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/level_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_top_level_tests {
namespace {

constexpr int steps = 1000;

HeavyTop top() {
  HeavyTop out;
  out.h = 0.02;
  return out;
}
const State<HeavyTop::GroupoidType> z{Vector<double, 3>(0.6, 0, 0.8), Vector<double, 3>(0.4, 0.3, 2)};

TEST(TopLevel, DerivativesAreThoseOfTheRouthianAndItsForces) {
  const auto level = level_through(ShortestRotation{}, top(), z);
  const auto b = level.groupoid.tau(z.object, Vector<double, 2>(0.03, -0.02));
  const auto d = level.two_sided(b, {});
  const auto f = level.forces(b);
  EXPECT_NEAR(d.value, level.lagrangian(b), 1e-14);
  for (int i = 0; i < 2; ++i) {
    Vector<Dual<double>, 2> v = Vector<Dual<double>, 2>::Constant(0.0);
    Vector<Dual<double>, 2> w = v;
    const auto along = [&] {
      return level.lagrangian(level.groupoid.translate(v, level.groupoid.cast<Dual<double>>(b), w)).derivative;
    };
    v(i).derivative = 1;
    EXPECT_NEAR(d.source_gradient(i), along() + f.source(i), 1e-12);
    std::swap(v, w);
    EXPECT_NEAR(d.target_gradient(i), along() + f.target(i), 1e-12);
    // The mixed derivative, by differences.
    const double step = 1e-5;
    const auto moved = [&](double by) {
      const auto to = level.groupoid.tau(b.target, Vector<double, 2>(by * Vector<double, 2>::Unit(i)));
      return level.two_sided(level.groupoid.multiply(b, to), {}).source_gradient;
    };
    EXPECT_LT((d.mixed.col(i) - (moved(step) - moved(-step)) / (2 * step)).norm(), 1e-6 * d.mixed.norm());
  }
}

TEST(TopLevel, IsTheTopOnTheSphereWithItsMagneticTerm) {
  const auto level = level_through(ShortestRotation{}, top(), z);
  EXPECT_NEAR(level.level(0), z.momentum.dot(z.object), 1e-15);
  EXPECT_TRUE(agree(run_level_beside(level, z, steps)));
}

TEST(TopLevel, HasTheAreaAsItsMagneticTerm) {
  // The holonomy round a small triangle of directions is its area: f+ along one side for a displacement along another.
  const MomentumLevel<ShortestRotation, HeavyTop> level({}, top(), Vector<double, 1>(1));
  const Vector<double, 3> m = Vector<double, 3>(0.3, -0.5, 0.7).normalized();
  const double side = 1e-3;
  const auto along = level.groupoid.tau(m, Vector<double, 2>(side, 0));
  const auto f = level.forces(along);
  EXPECT_NEAR(f.target.norm(), side / 2, 1e-6);
  EXPECT_NEAR(f.source.norm(), side / 2, 1e-6);
  EXPECT_NEAR(f.target.dot(Vector<double, 2>(1, 0)), 0, 1e-6) << "it is across";
  const auto unit = level.forces(level.groupoid.unit(m));
  EXPECT_LT(unit.source.norm() + unit.target.norm(), 1e-15);
}

TEST(TopLevel, OfAnotherMomentumIsSeen) {
  auto level = level_through(ShortestRotation{}, top(), z);
  level.level(0) += 1e-6;
  EXPECT_FALSE(agree(run_level_beside(level, z, 20)));
}
}  // namespace
}  // namespace reduction_reduced_top_level_tests
