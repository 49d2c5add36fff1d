// Steps by Ceres from random states of every system of the library, in every form it has: two thousand in a nightly
// program (they take minutes), a part of them every day.
#include <lagroid/solvers/step/step_methods.hpp>  // Moser-Veselov's are compiled here alone
#include <lagroid/solvers/testing/solver_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../boundary/control_cases.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace step_solver_laws_tests {
namespace {

#ifdef LAGROID_WHOLE_STEPS
constexpr int steps = 2000;
#else
constexpr int steps = 300;
#endif

template <class Sys, class Draw> void expect_solved(const Sys& system, const Draw& draw) {
  const auto report = laws::solver_laws(system, draw, StepMethod::ceres, steps);
  EXPECT_TRUE(report.holds()) << report;
}

Vector<double, 3> draw_direction() {
  return (laws::draw_vector<3>(1.0) + Vector<double, 3>(0.01, -0.02, 0.03)).normalized();
}

TEST(Ceres, MarchesAPlateBallInEveryForm) {
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    PlateBall system;
    system.h = 0.01;  // over twenty seconds: paths of optimal control run away, and in the end beyond where steps exist
    system.spin = 0.3;
    system.plate_rate = 0.8;
    system.rotation = form;
    expect_solved(system, [] {
      State<PlateBall::GroupoidType> s;
      std::get<0>(s.object) = laws::draw_vector<2>(1.0);
      for (double& x : s.momentum) x = laws::draw_uniform();
      return s;
    });
  }
}

TEST(Ceres, MarchesBodiesAndTops) {
  const auto momentum = [] { return State<SO3>{{}, laws::draw_vector<3>(2.0)}; };
  for (const auto rotation : {RotationMap::exponential, RotationMap::cayley}) {
    RigidBody body;
    body.h = 0.1;
    body.rotation = rotation;
    expect_solved(body, momentum);
    HeavyTop top;
    top.h = 0.1;
    top.inertia << 1.1, 0.8, 0.5;
    top.weight << 0.3, -0.2, 0.9;
    top.rotation = rotation;
    expect_solved(top, [] { return State<HeavyTop::GroupoidType>{draw_direction(), laws::draw_vector<3>(1.5)}; });
  }
  MoserVeselov discrete;
  discrete.h = 0.1;
  expect_solved(discrete, momentum);
}

TEST(Ceres, MarchesPointMasses) {
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    Pendulum pendulum;
    pendulum.quadrature = quadrature;
    expect_solved(pendulum, [] { return State<Pair<1>>{laws::draw_vector<1>(3.0), laws::draw_vector<1>(2.0)}; });
    Kepler kepler;
    kepler.quadrature = quadrature;
    expect_solved(kepler, [] {
      const Eigen::Vector2d wobble(0.2 * laws::draw_uniform(), 0.2 * laws::draw_uniform());
      return State<Pair<2>>{Eigen::Vector2d(1, 0) + wobble, Eigen::Vector2d(wobble(1), 1)};
    });
  }
}

TEST(Ceres, MarchesUnderObjectConstraints) {
  expect_solved(SphericalPendulum{}, [] {
    const Vector<double, 3> q = draw_direction();
    const Eigen::Vector3d p(laws::draw_uniform(), laws::draw_uniform(), laws::draw_uniform());
    return State<Pair<3>>{q, p - p.dot(q) * q};
  });
}

TEST(Ceres, MarchesControlledMotionsInBothForms) {
  const auto momentum = [] { return Vector<double, 3>(Vector<double, 3>(0.9, -0.4, 1.1) + laws::draw_vector<3>(0.3)); };
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    Case<Unicycle> unicycle;
    unicycle.system.map = map;
    expect_solved(unicycle.system, [&] { return State<SE2>{{}, momentum()}; });
    Case<AttitudeControl> attitude;
    attitude.system.map = map;
    expect_solved(attitude.system, [&] { return State<SO3>{{}, momentum()}; });
  }
}

TEST(Ceres, MarchesForcedAndDrivenSystems) {
  expect_solved(DampedPendulum{}, [] { return State<Pair<1>>{laws::draw_vector<1>(2.0), laws::draw_vector<1>(1.0)}; });
  DrivenBody body;
  body.torque << 0.1, 0.2, -0.05;
  expect_solved(body, [] { return State<SO3>{{}, laws::draw_vector<3>(2.0)}; });
  DrivenPendulum driven;
  driven.torque = 0.3;
  driven.amplitude = 0.1;
  driven.frequency = 2;
  expect_solved(driven, [] { return State<Pair<1>>{laws::draw_vector<1>(2.0), laws::draw_vector<1>(1.0)}; });
}

TEST(Ceres, MarchesNonholonomicSystems) {
  RollingBall ball;
  ball.plate_rate = 1.3;
  expect_solved(
      ball, [&] { return ball.rolling(laws::draw_vector<2>(1.0), laws::draw_vector<2>(1.0), laws::draw_uniform()); });
  const RollingDisk disk;
  expect_solved(disk, [&] { return disk.rolling(laws::draw_uniform(), 1.5 + laws::draw_uniform()); });
  const ChaplyginSleigh sleigh;
  expect_solved(sleigh, [&] { return sleigh.sliding(laws::draw_uniform(), 2 * laws::draw_uniform()); });
}

}  // namespace
}  // namespace step_solver_laws_tests
