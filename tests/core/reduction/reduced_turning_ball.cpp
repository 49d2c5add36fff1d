// The nonholonomic ball on a plate that turns, by rotations.

#include <lagroid/groupoids/rotated_plane.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include "../../support/reduced_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_turning_ball_tests {
namespace {

constexpr int steps = 1000;

struct NonholonomicReductionByRotations : testing::Test {
  RollingBall full;
  State<RollingBall::GroupoidType> z = full.rolling(Vector<double, 2>(1, 0.3), Vector<double, 2>(0.2, -0.1), 0.7);
  ArrowOf<RollingBall::GroupoidType> start = full.groupoid.unit(z.object);
  std::vector<ArrowOf<RollingBall::GroupoidType>> arrows = arrows_about(full.groupoid, z.object);
};

TEST_F(NonholonomicReductionByRotations, OfTheRollingBallByRotations) {
  full.plate_rate = 0.4;
  z = full.rolling(Vector<double, 2>(1, 0.3), Vector<double, 2>(0.2, -0.1), 0.7);
  const auto reduced = reduce(RotatedPlaneQuotient{}, full, arrows);
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, z.momentum, steps)));
}

/// A ball with one constraint only: it may slip along the first axis, and rotations see which that is.
struct Slipping : System<Slipping, RollingBall::GroupoidType, 1> {
  static constexpr auto principle = Principle::nonholonomic;
  RollingBall ball;
  template <class S> S lagrangian(const Arrow<S>& g) const { return ball.lagrangian(g); }
  template <class S> Vector<S, 1> constraint(const Arrow<S>& g) const { return Vector<S, 1>(ball.constraint(g)(0)); }
  Matrix<double, 5, 1> annihilator(const ObjectOf<RollingBall::GroupoidType>& q) const {
    return ball.annihilator(q).col(0);
  }
};
TEST_F(NonholonomicReductionByRotations, NamesADistributionThatDoesNotDescend) {
  const auto report = examine_descent(ReducedSystem<RotatedPlaneQuotient, Slipping>(),
                                      std::span<const ArrowOf<RollingBall::GroupoidType>>(arrows));
  ASSERT_FALSE(report.descends());
  for (const auto& finding : report.findings)
    EXPECT_EQ(finding.defect > 1e-3,
              finding.ingredient == Ingredient::constraint || finding.ingredient == Ingredient::distribution)
        << int(finding.ingredient);
}

}  // namespace
}  // namespace reduction_reduced_turning_ball_tests
