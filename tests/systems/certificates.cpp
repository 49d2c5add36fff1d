// The certificate of every system of the library, at random states and in every form it has. (The Moser-Veselov body's
// own properties: moser_veselov.cpp.)
#include <lagroid/core/testing/property.hpp>
#include <lagroid/systems/certificates.hpp>
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
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../solvers/boundary/control_cases.hpp"

#include <gtest/gtest.h>

#include <functional>

using namespace lagroid;

namespace systems_certificates_tests {
namespace {

template <class Sys> using Draw = std::function<State<typename Sys::GroupoidType>()>;

template <class Sys> void expect_certificate(const Sys& system, const Draw<Sys>& draw) {
  for (const auto& suite : laws::certificate(system, draw)) EXPECT_TRUE(suite.holds()) << suite;
}

Vector<double, 3> draw_direction() {
  return (laws::draw_vector<3>(1.0) + Vector<double, 3>(0.01, -0.02, 0.03)).normalized();
}

TEST(Certificate, PlateBallInEveryForm) {
  PlateBall system;
  system.h = 0.1;
  system.spin = 0.3;
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    system.rotation = form;
    system.plate_rate = form == RotationForm::trace ? 0.8 : 0;
    EXPECT_EQ(system.symmetries().size(), system.plate_rate == 0 ? 3U : 1U);
    expect_certificate<PlateBall>(system, [] {
      State<PlateBall::GroupoidType> s;
      std::get<0>(s.object) = laws::draw_vector<2>(1.0);
      for (double& x : s.momentum) x = laws::draw_uniform();
      return s;
    });
  }
}

TEST(Certificate, RigidBodyInBothForms) {
  for (const auto rotation : {RotationMap::exponential, RotationMap::cayley}) {
    RigidBody system;
    system.h = 0.1;
    system.rotation = rotation;
    expect_certificate<RigidBody>(system, [] { return State<SO3>{{}, laws::draw_vector<3>(2.0)}; });
  }
}

TEST(Certificate, ForcedAndNonholonomicSystems) {
  DampedPendulum pendulum;
  expect_certificate<DampedPendulum>(pendulum, [] {
    return State<Pair<1>>{laws::draw_vector<1>(2.0), laws::draw_vector<1>(1.0)};
  });
  DrivenBody body;
  body.torque << 0.1, 0.2, -0.05;
  expect_certificate<DrivenBody>(body, [] { return State<SO3>{{}, laws::draw_vector<3>(2.0)}; });
  RollingBall ball;
  ball.plate_rate = 1.3;
  expect_certificate<RollingBall>(
      ball, [&] { return ball.rolling(laws::draw_vector<2>(1.0), laws::draw_vector<2>(1.0), laws::draw_uniform()); });
  const RollingDisk disk;
  expect_certificate<RollingDisk>(disk, [&] { return disk.rolling(laws::draw_uniform(), 1.5 + laws::draw_uniform()); });
  const ChaplyginSleigh sleigh;
  expect_certificate<ChaplyginSleigh>(sleigh,
                                      [&] { return sleigh.sliding(laws::draw_uniform(), 2 * laws::draw_uniform()); });
}

TEST(Certificate, HeavyTopInBothForms) {
  for (const auto rotation : {RotationMap::exponential, RotationMap::cayley}) {
    HeavyTop top;
    top.h = 0.1;
    top.inertia << 1.1, 0.8, 0.5;
    top.weight << 0.3, -0.2, 0.9;
    top.rotation = rotation;
    EXPECT_EQ(top.symmetries().size(), 1U);
    expect_certificate<HeavyTop>(top, [] {
      return State<HeavyTop::GroupoidType>{draw_direction(), laws::draw_vector<3>(1.5)};
    });
  }
}

TEST(Certificate, PointMasses) {
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    Pendulum pendulum;
    pendulum.quadrature = quadrature;
    expect_certificate<Pendulum>(pendulum, [] {
      return State<Pair<1>>{laws::draw_vector<1>(3.0), laws::draw_vector<1>(2.0)};
    });
    Kepler kepler;
    kepler.quadrature = quadrature;
    expect_certificate<Kepler>(kepler, [] {
      const Eigen::Vector2d wobble(0.2 * laws::draw_uniform(), 0.2 * laws::draw_uniform());
      return State<Pair<2>>{Eigen::Vector2d(1, 0) + wobble, Eigen::Vector2d(wobble(1), 1)};
    });
  }
}

TEST(Certificate, DrivenPendulum) {
  DrivenPendulum pendulum;
  pendulum.torque = 0.4;
  pendulum.amplitude = 0.1;
  pendulum.frequency = 2.3;
  pendulum.time = 0.7;
  expect_certificate<DrivenPendulum>(pendulum, [] {
    return State<Pair<1>>{laws::draw_vector<1>(3.0), laws::draw_vector<1>(2.0)};
  });
}

TEST(Certificate, SphericalPendulum) {
  expect_certificate<SphericalPendulum>(SphericalPendulum{}, [] {
    const Vector<double, 3> q = draw_direction();
    const Eigen::Vector3d p(laws::draw_uniform(), laws::draw_uniform(), laws::draw_uniform());
    return State<Pair<3>>{q, p - p.dot(q) * q};
  });
}

TEST(Certificate, ControlOnGroupsInBothForms) {
  // Away from rest, where the constraints of a path are dependent.
  const auto momentum = [] { return Vector<double, 3>(Vector<double, 3>(0.9, -0.4, 1.1) + laws::draw_vector<3>(0.3)); };
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    Case<Unicycle> unicycle;
    unicycle.system.h = 0.1;
    unicycle.system.map = map;
    expect_certificate<Unicycle>(unicycle.system, [&] { return State<SE2>{{}, momentum()}; });
    Case<AttitudeControl> attitude;
    attitude.system.h = 0.1;
    attitude.system.map = map;
    expect_certificate<AttitudeControl>(attitude.system, [&] { return State<SO3>{{}, momentum()}; });
  }
  // With equal weights the forbidden axis is an axis of symmetry.
  AttitudeControl axial;
  axial.h = 0.1;
  EXPECT_EQ(axial.symmetries().size(), 1U);
  expect_certificate<AttitudeControl>(axial, [&] { return State<SO3>{{}, momentum()}; });
}

TEST(Certificate, WhereNoStepCanBeTakenIsWithheld) {
  // So fast that a step would be longer than the sphere is wide.
  int of_steps = 0;
  for (const auto& suite : laws::certificate<SphericalPendulum>(SphericalPendulum{}, [] {
         return State<Pair<3>>{Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1e4 * (2 + laws::draw_uniform()), 0, 0)};
       })) {
    if (suite.subject != "derivatives" && suite.subject != "dynamics" && suite.subject != "action principle") continue;
    ++of_steps;
    for (const auto& law : suite.laws) {
      EXPECT_FALSE(law.holds()) << suite;
      EXPECT_EQ(law.samples, 0) << suite;
    }
  }
  EXPECT_EQ(of_steps, 3);
}

}  // namespace
}  // namespace systems_certificates_tests
