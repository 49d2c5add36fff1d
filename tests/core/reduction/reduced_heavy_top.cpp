// The heavy top on pairs of attitudes, reduced by rotations about the vertical.

#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/reduced_runs.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace reduction_reduced_heavy_top_tests {
namespace {

using Attitude = Matrix<double, 3, 3>;
constexpr int steps = 1000;

/// The heavy top on pairs of attitudes, its vertical the third axis in space.
struct TopOnPairs : System<TopOnPairs, PairOf<SO3>> {
  double h = 0.02;
  HeavyTop below;
  double sideways = 0;  ///< breaks the symmetry: weight along the first axis in space
  template <class A> auto lagrangian(const A& g) const {
    using S = typename std::remove_cvref_t<decltype(g.target)>::Scalar;
    const auto& w = below.weight;
    S height(0.0);
    for (int j = 0; j < 3; ++j) height += (g.source(2, j) + g.target(2, j)) * w(j);
    return S(rotational_action(groupoid.quotient(g), below.inertia, h, below.rotation) - height * (0.5 * h) -
             (g.source(0, 2) + g.target(0, 2)) * sideways);
  }
};
using AboutTheVertical = StabiliserQuotient<SO3, RotatedDirections>;

TEST(Reduction, OfTheHeavyTopByTurnsAboutTheVertical) {
  const AboutTheVertical phi(Vector<double, 3>::UnitZ());
  const TopOnPairs full;
  const auto arrows = arrows_about(full.groupoid, Attitude::Identity().eval(), 2);
  const auto reduced = reduce(phi, full, arrows);
  const ElementPair<Attitude> start{Attitude::Identity(), SO3::exp(Vector<double, 3>(2.3, 0.1, 0.8))};
  const Vector<double, 3> momentum(0.4, 0.3, 2);
  HeavyTop top;
  top.h = full.h;
  EXPECT_TRUE(agree(run_side_by_side(reduced, top, start, momentum, steps)));
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, momentum, steps)));
}
TEST(BrokenReduction, OfATopWithWeightSideways) {
  TopOnPairs full;
  full.sideways = 1e-4;
  const auto arrows = arrows_about(full.groupoid, Attitude::Identity().eval(), 2);
  EXPECT_THROW(reduce(AboutTheVertical(Vector<double, 3>::UnitZ()), full, arrows), DoesNotDescend);
  // Nor is its group any larger.
  EXPECT_THROW(reduce(LeftQuotient<SO3>{}, TopOnPairs{}, arrows), DoesNotDescend);
}

}  // namespace
}  // namespace reduction_reduced_heavy_top_tests
