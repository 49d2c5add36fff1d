// Quotients by rotations, discrete connections and pairs of points; a connection that is none is found out.

#include <lagroid/core/testing/algebroid_laws.hpp>
#include <lagroid/core/testing/connection_laws.hpp>
#include <lagroid/core/testing/morphism_laws.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/groupoids/polar.hpp>
#include <lagroid/groupoids/rotated_plane.hpp>

#include "../support/broken.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace groupoids_quotients_tests {
namespace {

laws::GroupoidLawOptions small() {
  laws::GroupoidLawOptions o;
  o.large = 0.4;
  return o;
}
Vector<double, 2> draw_place() {
  const double angle = 3 * laws::draw_uniform();
  return (2 + 0.5 * laws::draw_uniform()) * Vector<double, 2>(std::cos(angle), std::sin(angle));
}
Vector<double, 3> draw_direction() {
  return SO3::exp(Vector<double, 3>(laws::draw_vector<3>(2.0))) * Vector<double, 3>::UnitZ();
}

TEST(Quotients, ByRotationsOfThePlane) {
  const auto polar = laws::morphism_laws(PolarQuotient{}, draw_place, small());
  EXPECT_TRUE(polar.holds()) << polar;
  const auto plate = laws::morphism_laws(
      RotatedPlaneQuotient{}, [] { return std::tuple(draw_place(), Vector<double, 0>()); }, small());
  EXPECT_TRUE(plate.holds()) << plate;
}

/// What it says for reduction downward is wrong.
struct Careless : PolarQuotient {
  template <class S> PairArrow<S, 2> representative(const Polar<S>& g) const {
    const auto stands = PolarQuotient::representative(g);
    return {stands.source, stands.target * 1.01};
  }
  template <class S> Vector<S, 2> reduced_momentum(const Vector<S, 2>&, const Vector<S, 2>& mu) const { return mu; }
};
TEST(BrokenQuotient, IsFoundOut) {
  const auto report = laws::morphism_laws(Careless{}, draw_place, small());
  for (const auto* law : {"representatives", "momenta go down and up"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

TEST(Quotients, ByTheStabiliserOfADirection) {
  const auto draw_attitude = [] {
    return Matrix<double, 3, 3>(SO3::exp(Vector<double, 3>(laws::draw_vector<3>(2.0))));
  };
  const StabiliserQuotient<SO3, RotatedDirections> phi(Vector<double, 3>(0.6, 0, 0.8));
  const auto report = laws::morphism_laws(phi, draw_attitude, small());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(PairOfPoints, IsAGroupoidWithItsAlgebroid) {
  const auto axioms = laws::groupoid_laws(PairOfPoints<RotatedDirections>{}, draw_direction, small());
  EXPECT_TRUE(axioms.holds()) << axioms;
  const auto algebroid = laws::algebroid_laws(PairOfPoints<RotatedDirections>{}, draw_direction, small());
  EXPECT_TRUE(algebroid.holds()) << algebroid;
}

TEST(Connections, OfTheLibrary) {
  const auto sphere = laws::connection_laws(ShortestRotation{}, draw_direction, small());
  EXPECT_TRUE(sphere.holds()) << sphere;
  using Wheels = FactorConnection<Factors<0, 2>, SO2, Pair<2>, SO2>;
  const auto point = [] { return std::tuple(Vector<double, 0>(), draw_place(), Vector<double, 0>()); };
  const auto wheels = laws::connection_laws(Wheels{}, point, small());
  EXPECT_TRUE(wheels.holds()) << wheels;
}

/// Angles a hundredth too large, called flat, with a basis that does not turn.
struct Stretched : ShortestRotation {
  static constexpr bool flat = true;
  template <class S> Vector<S, 1> angle(const ActionArrow<Matrix<S, 3, 3>, Vector<S, 3>>& g) const {
    return ShortestRotation::angle(g) * 1.01;
  }
  static Matrix<double, 3, 3> adapted_basis(const Vector<double, 3>&) { return Matrix<double, 3, 3>::Identity(); }
};
TEST(BrokenConnection, IsFoundOut) {
  const auto report = laws::connection_laws(Stretched{}, draw_direction, small());
  for (const auto* law : {"base and angle determine the arrow", "angles add along the fibres",
                          "a flat connection is a morphism", "adapted basis"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

}  // namespace
}  // namespace groupoids_quotients_tests
