// The planar Kepler problem in polar coordinates, by rotations about the centre.

#include <lagroid/groupoids/polar.hpp>
#include <lagroid/systems/kepler.hpp>

#include "../../support/reduced_runs.hpp"

using namespace lagroid;

namespace reduction_reduced_kepler_tests {
namespace {

constexpr int steps = 1000;

TEST(Reduction, OfThePlanarKeplerProblemByRotations) {
  Kepler full;
  full.h = 0.02;
  const Vector<double, 2> q(1, 0.2);
  const auto reduced = reduce(PolarQuotient{}, full, arrows_about(full.groupoid, q));
  const PairArrow<double, 2> start{Vector<double, 2>(0.7, -0.4), q};
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, Vector<double, 2>(-0.3, 0.9), steps)));
}

TEST(Reduction, KnowsWhereRotationsAreNotFree) {
  const ReducedSystem<PolarQuotient, Kepler> reduced;
  const auto arrow_to = [](double r) {
    return PolarQuotient::Polar<double>{{Vector<double, 1>(1), Vector<double, 1>(r)}, Matrix<double, 2, 2>::Identity()};
  };
  EXPECT_TRUE(reduced.admissible(arrow_to(0.5)));
  EXPECT_FALSE(reduced.admissible(arrow_to(0)));
  EXPECT_FALSE(reduced.admissible(arrow_to(-0.5)));
}

/// Attracted more along the first axis than along the second.
struct Flattened : MechanicalSystem<Flattened, 2> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const { return q(0) * q(0) * (0.5 + 1e-4) + q(1) * q(1) * 0.5; }
};
TEST(BrokenReduction, OfAFlattenedPotentialByRotations) {
  const Flattened full;
  const auto arrows = arrows_about(full.groupoid, Vector<double, 2>(1, 0.2));
  EXPECT_THROW(reduce(PolarQuotient{}, full, arrows), DoesNotDescend);
}

}  // namespace
}  // namespace reduction_reduced_kepler_tests
