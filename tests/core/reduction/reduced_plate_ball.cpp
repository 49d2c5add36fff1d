// The plate-ball problem: by translations of the plate at rest, by rotations of the turning one.

#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/groupoids/rotated_plane.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include "../../support/reduced_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_plate_ball_tests {
namespace {

constexpr int steps = 1000;
using ByTranslations = ProductMorphism<Difference<2>, IdentityMorphism<SO3>>;
using Start = PlateBall::GroupoidType::Arrow<double>;

Start start() {
  return {{Vector<double, 2>(0.1, 0.2), Vector<double, 2>(1, 0.3)}, SO3::exp(Vector<double, 3>(0.1, 0.2, 0.3))};
}
Vector<double, 5> momentum() {
  Vector<double, 5> mu;
  mu << 0.3, -0.2, 0.15, 0.1, 0.25;
  return mu;
}

TEST(Reduction, OfThePlateBallByTranslations) {
  PlateBall full;
  full.h = 0.02;
  full.radius = 0.8;
  full.spin = 0.3;
  const auto arrows = arrows_about(full.groupoid, full.groupoid.target(start()));
  const auto reduced = reduce(ByTranslations{}, full, arrows);
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start(), momentum(), steps)));
  full.plate_rate = 1e-3;
  try {
    reduce(ByTranslations{}, full, arrows);
    FAIL() << "the plate turns about a point";
  } catch (const DoesNotDescend& refused) {
    EXPECT_EQ(refused.report.worst()->ingredient, Ingredient::constraint);
  }
}

TEST(Reduction, OfThePlateBallByRotations) {
  PlateBall full;
  full.h = 0.02;
  full.spin = 0.3;
  full.plate_rate = 0.4;
  const auto arrows = arrows_about(full.groupoid, full.groupoid.target(start()));
  const auto reduced = reduce(RotatedPlaneQuotient{}, full, arrows);
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start(), momentum(), steps)));
}

/// A plate that turns about another point.
struct OffCentre : System<OffCentre, PlateBall::GroupoidType, 3> {
  PlateBall centred;
  Vector<double, 2> centre{1e-3, 0};
  template <class S> S lagrangian(const Arrow<S>& g) const { return centred.lagrangian(g); }
  template <class S> Vector<S, 3> constraint(const Arrow<S>& g) const {
    auto moved = g;
    auto& move = std::get<0>(moved);
    for (int i = 0; i < 2; ++i) {
      move.source(i) -= centre(i);
      move.target(i) -= centre(i);
    }
    return centred.constraint(moved);
  }
};
TEST(BrokenReduction, OfAPlateThatTurnsAboutAnotherPoint) {
  OffCentre full;
  full.centred.plate_rate = 0.4;
  const auto arrows = arrows_about(full.groupoid, full.groupoid.target(start()));
  EXPECT_THROW(reduce(RotatedPlaneQuotient{}, full, arrows), DoesNotDescend);
}

}  // namespace
}  // namespace reduction_reduced_plate_ball_tests
