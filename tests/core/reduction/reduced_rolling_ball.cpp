// The nonholonomic ball on a plate at rest, by translations.

#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include "../../support/reduced_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_rolling_ball_tests {
namespace {

constexpr int steps = 1000;
using ByTranslations = ProductMorphism<Difference<2>, IdentityMorphism<SO3>>;

struct NonholonomicReduction : testing::Test {
  RollingBall full;
  State<RollingBall::GroupoidType> z = full.rolling(Vector<double, 2>(1, 0.3), Vector<double, 2>(0.2, -0.1), 0.7);
  ArrowOf<RollingBall::GroupoidType> start = full.groupoid.unit(z.object);
  std::vector<ArrowOf<RollingBall::GroupoidType>> arrows = arrows_about(full.groupoid, z.object);
};

TEST_F(NonholonomicReduction, OfTheRollingBallByTranslations) {
  const auto reduced = reduce(ByTranslations{}, full, arrows);
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, z.momentum, steps)));
  full.plate_rate = 1e-3;
  EXPECT_THROW(reduce(ByTranslations{}, full, arrows), DoesNotDescend);
}

}  // namespace
}  // namespace reduction_reduced_rolling_ball_tests
