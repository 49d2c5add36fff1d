// The laws of a momentum level among object constraints: of a spherical pendulum in cylinder coordinates.
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/testing/level_laws.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace level_laws_bob_tests {
namespace {

/// A bob at (distance from the axis, angle, height) on the unit sphere.
using Cylinder = Product<Pair<1>, SO2, Pair<1>>;
struct Bob : System<Bob, Cylinder, 0, 1> {
  double h = 0.02;
  template <class S> S lagrangian(const ArrowOf<Cylinder, S>& g) const {
    const auto& [distance, turn, height] = g;
    const S r = distance.source(0);
    const S s = distance.target(0);
    const S rise = height.target(0) - height.source(0);
    return (r * r + s * s - r * s * turn.trace() + rise * rise) * (0.5 / h) -
           (height.source(0) + height.target(0)) * (0.5 * h);
  }
  template <class Q> auto object_constraint(const Q& q) const {
    const auto& [distance, turn, height] = q;
    using S = typename std::remove_cvref_t<decltype(distance)>::Scalar;
    return Vector<S, 1>((distance(0) * distance(0) + height(0) * height(0) - 1.0) * 0.5);
  }
};

TEST(LevelLaws, OfASphericalPendulum) {
  const MomentumLevel<FactorConnection<Factors<1>, Pair<1>, SO2, Pair<1>>, Bob> level({}, Bob{}, Vector<double, 1>(0));
  const auto report = laws::level_laws(level, [] {
    const double angle = 0.9 + 0.3 * laws::draw_uniform();
    const double along = 0.5 * laws::draw_uniform();
    return State<Cylinder>{{Vector<double, 1>(std::sin(angle)), {}, Vector<double, 1>(-std::cos(angle))},
                           {along * std::cos(angle), 0.5 + 0.2 * laws::draw_uniform(), along * std::sin(angle)}};
  });
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace level_laws_bob_tests
