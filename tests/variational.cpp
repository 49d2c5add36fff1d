// The action principle for systems of every kind; what is no trajectory is found out.
#include <lagroid/solvers/testing/variational_laws.hpp>
#include <lagroid/systems/heavy_top.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/plate_ball.hpp>
#include <lagroid/systems/rigid_body.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace {

template <class Sys, class Draw> void expect_laws(const Sys& system, const Draw& draw) {
  const auto report = laws::variational_laws(system, draw);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(ActionPrinciple, HoldsOnGroupsPairsAndActions) {
  RigidBody body;
  body.h = 0.1;
  expect_laws(body, [] { return State<SO3>{{}, Vector<double, 3>(1, laws::draw_uniform(), laws::draw_uniform())}; });
  Kepler orbit;
  orbit.h = 0.1;
  expect_laws(orbit, [] {
    return State<Pair<2>>{{1, 0.2 * laws::draw_uniform()}, {0.1, 1 + 0.1 * laws::draw_uniform()}};
  });
  HeavyTop top;
  top.h = 0.1;
  top.weight << 0.3, 0.1, 0.8;
  expect_laws(top, [] {
    const Vector<double, 3> v = Vector<double, 3>(laws::draw_uniform(), laws::draw_uniform(), 1.1).normalized();
    return State<HeavyTop::GroupoidType>{v, Vector<double, 3>(1, laws::draw_uniform(), laws::draw_uniform())};
  });
}

TEST(ActionPrinciple, HoldsUnderConstraints) {
  PlateBall plate;
  plate.h = 0.1;
  plate.plate_rate = 0.6;
  expect_laws(plate, [] {
    State<PlateBall::GroupoidType> s;
    std::get<0>(s.object) = laws::draw_vector<2>(1.0);
    for (double& x : s.momentum) x = laws::draw_uniform();
    return s;
  });
  SphericalPendulum pendulum;
  pendulum.h = 0.1;
  expect_laws(pendulum, [] { return State<Pair<3>>{{0.6, 0, -0.8}, {0, 1 + 0.5 * laws::draw_uniform(), 0}}; });
}

/// An oscillator; a straight line is no trajectory of it.
struct Oscillator : System<Oscillator, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 / h) - (g.source(0) * g.source(0) + g.target(0) * g.target(0)) * (0.25 * h);
  }
};
TEST(BrokenActionPrinciple, ATrajectoryOfAnotherSystemIsNotCritical) {
  const Oscillator system;
  Path<Oscillator> straight;
  for (int k = 0; k < 4; ++k)
    straight.push_back({{Vector<double, 1>(1 + 0.1 * k), Vector<double, 1>(1.1 + 0.1 * k)}, {}});
  EXPECT_GT(laws::detail::criticality_defect(laws::detail::first_variation(system, straight)), 1e-3);
}

}  // namespace
