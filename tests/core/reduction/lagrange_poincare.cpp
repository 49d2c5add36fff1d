// Gauge groupoids that connections split, and the Lagrange-Poincare equations there; connections that are none are
// found out.

#include <lagroid/core/testing/split_laws.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/broken.hpp"
#include "body_with_a_mass.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace reduction_lagrange_poincare_tests {
namespace {

laws::GroupoidLawOptions small() {
  laws::GroupoidLawOptions o;
  o.large = 0.4;
  return o;
}
Vector<double, 2> draw_shape() { return laws::draw_vector<2>(0.5); }
Step<BodyWithAMass> draw_step() {
  const Vector<double, 3> turn = laws::draw_vector<3>(0.4);
  return {{{draw_shape(), draw_shape()}, SO3::exp(turn)}, {}};
}
Vector<double, 3> draw_direction() {
  return SO3::exp(Vector<double, 3>(laws::draw_vector<3>(2.0))) * Vector<double, 3>::UnitZ();
}

TEST(SplitGauge, IsAGroupoid) {
  const auto report = laws::groupoid_laws(SplitGauge<Mechanical>{}, draw_shape, small());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(SplitGauge, IsSplitByItsConnection) {
  const auto report = laws::splitting_laws(SplitGauge<Mechanical>{}, draw_shape, small());
  EXPECT_TRUE(report.holds()) << report;
  const auto sphere = laws::splitting_laws(SplitGauge<ShortestRotation>{}, draw_direction, small());
  EXPECT_TRUE(sphere.holds()) << sphere;
}

TEST(LagrangePoincare, EquationsAreThoseOfTheUnsplitSystem) {
  const auto report = laws::lagrange_poincare_laws(Unsplit<Mechanical>{}, BodyWithAMass{}, draw_step);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(LagrangePoincare, EquationsOverTheSphereAreThoseOfTheTop) {
  const auto draw = [] {
    const HeavyTop::GroupoidType groupoid;
    return Step<HeavyTop>{groupoid.tau(draw_direction(), Vector<double, 3>(laws::draw_vector<3>(0.4))), {}};
  };
  const auto report = laws::lagrange_poincare_laws(Unsplit<ShortestRotation>{}, HeavyTop{}, draw);
  EXPECT_TRUE(report.holds()) << report;
}

/// Bodies are carried along by more than the connection says, units included, and gamma is taken at the other end.
struct NotHorizontal : Mechanical {
  template <class S> using Turn = Matrix<S, 3, 3>;
  template <class S> Turn<S> element(const std::tuple<PairArrow<S, 2>, Turn<S>>& g) const {
    const auto& [b, turn] = g;
    return SO3{}.inverse(Turn<S>(transport(b.source, b.target))) * turn;
  }
  template <class S> std::tuple<PairArrow<S, 2>, Turn<S>> attach(const PairArrow<S, 2>& b, const Turn<S>& gamma) const {
    const Vector<S, 3> more(S(0.1), S(0), S(0));
    return {b, gamma * Turn<S>(transport(b.source, b.target)) * SO3::exp(more)};
  }
};
TEST(BrokenSplitting, IsFoundOut) {
  const auto report = laws::splitting_laws(SplitGauge<NotHorizontal>{}, draw_shape, small());
  for (const auto* law :
       {"base and element determine the arrow", "elements multiply along the fibre", "units are horizontal"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

TEST(BrokenLagrangePoincare, OfAConnectionThatIsNoneIsFoundOut) {
  const auto report = laws::lagrange_poincare_laws(Unsplit<NotHorizontal>{}, BodyWithAMass{}, draw_step);
  for (const auto* law :
       {"horizontal equations are those of the unsplit system", "vertical equations are those of the unsplit system",
        "vertical momenta are carried along arrows"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

}  // namespace
}  // namespace reduction_lagrange_poincare_tests
