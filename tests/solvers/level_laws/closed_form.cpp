// The laws of a momentum level whose Routhian was solved for on paper: Kepler's radius, a satellite's body.
#include "broken_laws.hpp"

#include <lagroid/core/reduction/reduced_system.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace level_laws_closed_form_tests {
namespace {

template <class Full> using Polar = ReducedSystem<PolarQuotient, Full>;
template <class Full> MomentumLevel<Kepler::ByTheAngle, Polar<Full>> level_of(const Full& planet) {
  return {Kepler::ByTheAngle{}, Polar<Full>(planet), Vector<double, 1>(0)};
}
Kepler planet() {
  Kepler out;
  out.h = 0.05;
  out.strength = 1.3;
  return out;
}
State<Trivial<1, SO2>> draw_planet() {
  return {{Vector<double, 1>(1.2 + 0.4 * laws::draw_uniform()), {}},
          {0.5 * laws::draw_uniform(), 0.9 + 0.5 * laws::draw_uniform()}};
}

TEST(LevelLaws, OfAPlanetInClosedForm) {
  ASSERT_TRUE(level_of(planet()).has_closed_form());
  const auto report = laws::level_laws(level_of(planet()), draw_planet);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(LevelLaws, OfAPlanetWhosePotentialIsInTheMiddle) {
  auto middle = planet();
  middle.quadrature = Quadrature::midpoint;
  ASSERT_FALSE(level_of(middle).has_closed_form());
  const auto report = laws::level_laws(level_of(middle), draw_planet);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(LevelLaws, OfTheGyrostatInClosedForm) {
  Gyrostat satellite;
  satellite.h = 0.05;
  const MomentumLevel level(Gyrostat::ByTheRotors{}, satellite, Vector<double, 3>(0, 0, 0));
  const auto report = laws::level_laws(level, [] {
    State<Gyrostat::GroupoidType> z;
    for (double& x : z.momentum) x = laws::draw_uniform();
    return z;
  });
  EXPECT_TRUE(report.holds()) << report;
}

/// A planet whose Routhian has forgotten the attraction at the end of the arrow.
struct Forgetful : System<Forgetful, Pair<2>> {
  Kepler planet;
  Forgetful() { planet.h = 0.05; }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return planet.lagrangian(g); }
  template <class S, class T>
  S routhian(const Kepler::ByTheAngle& by, const PairArrow<S, 1>& b, const Vector<T, 1>& momentum) const {
    return planet.routhian(by, b, momentum) - (1.0 / b.target(0)) * (0.5 * planet.h);
  }
};
TEST(BrokenLevel, InAWrongClosedFormIsFoundOut) {
  const Names broken = broken_laws(laws::level_laws(level_of(Forgetful{}), draw_planet));
  EXPECT_EQ(broken, (Names{"the Routhian and its magnetic term give the momenta",
                           "the Routhian in closed form, and the angle by it, are those of Newton's method",
                           "steps are those of the full system"}));
}

/// One whose Routhian is off by a function of the momentum alone: it moves as it should, by another angle.
struct Offset : Forgetful {
  template <class S, class T>
  S routhian(const Kepler::ByTheAngle& by, const PairArrow<S, 1>& b, const Vector<T, 1>& momentum) const {
    return planet.routhian(by, b, momentum) - momentum(0) * (1e-3 * planet.h);
  }
};
TEST(BrokenLevel, InAClosedFormOfAnotherAngleIsFoundOut) {
  const Names broken = broken_laws(laws::level_laws(level_of(Offset{}), draw_planet));
  EXPECT_EQ(broken,
            (Names{"the Routhian and its magnetic term give the momenta",
                   "the Routhian in closed form, and the angle by it, are those of Newton's method",
                   "steps are those of the full system", "full arrows have the momentum of the level at both ends"}));
}

}  // namespace
}  // namespace level_laws_closed_form_tests
