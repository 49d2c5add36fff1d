// The other systems: order against references, closed forms, conserved quantities, hidden constraints.
#include <lagroid/solvers/generating/loop_integral.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../support/broken.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace lagroid;

namespace systems_mechanics_tests {
namespace {

template <class Sys> FixedStepIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  return FixedStepIntegrator<Sys>(system, state, system.groupoid.unit(state.object),
                                  std::make_unique<NewtonStep<Sys>>());
}

template <class Sys>
State<typename Sys::GroupoidType> integrate(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                            int steps) {
  auto integrator = make(system, start);
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(integrator.advance().converged()) << k;
  auto state = integrator.point().state;
  state.momentum = tangent_momentum(system, state);
  return state;
}

// The slope of the error at time `horizon` over halved steps.
template <class Sys>
void expect_order_two(Sys system, const State<typename Sys::GroupoidType>& start, double horizon, int coarse) {
  const auto exact = system.reference(start, horizon);
  std::vector<double> errors;
  for (const int steps : {coarse, 2 * coarse, 4 * coarse}) {
    system.h = horizon / steps;
    const auto end = integrate(system, start, steps);
    errors.push_back((end.object - exact.object).norm() + (end.momentum - exact.momentum).norm());
  }
  for (int i = 0; i + 1 < int(errors.size()); ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2.0, 0.05);
}

TEST(Pendulum, OrderTwo) {
  Pendulum system;
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    system.quadrature = quadrature;
    expect_order_two(system, {Vector<double, 1>(1.2), Vector<double, 1>(0.3)}, 5.0, 200);
  }
}

TEST(Pendulum, PeriodIsTheEllipticIntegral) {
  Pendulum system;
  const double amplitude = 2.0;
  const double period = 4 * std::comp_ellint_1(std::sin(amplitude / 2));
  const auto back = system.reference({Vector<double, 1>(amplitude), Vector<double, 1>(0.0)}, period);
  EXPECT_NEAR(back.object(0), amplitude, 1e-12);
  EXPECT_NEAR(back.momentum(0), 0, 1e-11);
}

TEST(Kepler, OrderTwo) {
  Kepler system;
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    system.quadrature = quadrature;
    expect_order_two(system, {{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}}, 3.0, 600);
  }
}

TEST(Kepler, ReferenceSolvesKeplersEquation) {
  const Kepler system;
  const double e = 0.6;
  const double t = 2.0;
  double anomaly = t;
  for (int i = 0; i < 100; ++i) anomaly -= (anomaly - e * std::sin(anomaly) - t) / (1 - e * std::cos(anomaly));
  const auto end = system.reference({{1 - e, 0}, {0, std::sqrt((1 + e) / (1 - e))}}, t);
  EXPECT_NEAR(end.object(0), std::cos(anomaly) - e, 1e-12);
  EXPECT_NEAR(end.object(1), std::sqrt(1 - e * e) * std::sin(anomaly), 1e-12);
}

TEST(Kepler, MomentaAreConserved) {
  Kepler system;
  const auto report = laws::momentum_laws(system, [] {
    const Vector<double, 4> wobble = 0.2 * laws::draw_vector<4>(1.0);
    return State<Pair<2>>{{1 + wobble(0), wobble(1)}, {wobble(2), 1 + wobble(3)}};
  });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(SphericalPendulum, OrderTwoInProjectedMomentum) {
  SphericalPendulum system;
  system.gravity = 2;
  expect_order_two(system, {{0.6, 0, -0.8}, {0, 0.9, 0}}, 2.0, 100);
}

TEST(SphericalPendulum, StaysOnTheSphereWithTangentMomentum) {
  SphericalPendulum system;
  system.h = 0.02;
  system.length = 1.5;
  auto integrator = make(system, {{0.9, 0, -1.2}, {0.2, 0.7, 0.15}});
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    const auto& s = integrator.point().state;
    EXPECT_NEAR(s.object.norm(), 1.5, 1e-14);
    EXPECT_NEAR(s.object.dot(tangent_momentum(system, s)), 0, 1e-14);
  }
}

TEST(SphericalPendulum, ProjectionDoesNotChangeTheDynamics) {
  // Projecting mu after every step (RATTLE) or never (SHAKE) gives the same positions.
  SphericalPendulum system;
  system.h = 0.02;
  auto shake = make(system, {{0.6, 0, -0.8}, {0, 0.9, 0}});
  State<Pair<3>> rattle{{0.6, 0, -0.8}, {0, 0.9, 0}};
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(shake.advance().converged());
    auto one = make(system, rattle);
    ASSERT_TRUE(one.advance().converged());
    rattle = one.point().state;
    rattle.momentum = tangent_momentum(system, rattle);
    EXPECT_LT((rattle.object - shake.point().state.object).norm(), 1e-13);
  }
}

TEST(SphericalPendulum, MomentaAreConserved) {
  SphericalPendulum system;
  const auto report = laws::momentum_laws(system, [] {
    const Vector<double, 3> q = Vector<double, 3>(0.6, 0.1, -0.7).normalized();
    Vector<double, 3> p = laws::draw_vector<3>(1.0);
    p -= q * q.dot(p);
    return State<Pair<3>>{q, p};
  });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(RigidBody, OrderTwoInMomentumAndAttitude) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    RigidBody system;
    system.rotation = map;
    State<SO3> start;
    start.momentum << 0.3, 1.5, 0.4;
    constexpr double horizon = 3;
    Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
    const auto exact = system.reference(start, attitude, horizon);
    std::vector<double> errors;
    for (const int steps : {100, 200, 400}) {
      system.h = horizon / steps;
      auto integrator = make(system, start);
      for (int k = 0; k < steps; ++k) ASSERT_TRUE(integrator.advance().converged());
      errors.push_back((integrator.point().state.momentum - exact.momentum).norm() +
                       (integrator.point().configuration - attitude).norm());
    }
    for (int i = 0; i + 1 < int(errors.size()); ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2.0, 0.05);
  }
}

TEST(RigidBody, SteadyRotationIsExactWithTheExponential) {
  RigidBody system;
  system.h = 0.1;
  State<SO3> start;
  start.momentum << 0, 0, 1.5;
  auto integrator = make(system, start);
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_LT((integrator.point().configuration - SO3::exp(Vector<double, 3>(0, 0, 0.5 * 5))).norm(), 1e-13);
}

TEST(RigidBody, MomentaAreConserved) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    RigidBody system;
    system.h = 0.05;
    system.rotation = map;
    const auto report = laws::momentum_laws(system, [] {
      State<SO3> s;
      s.momentum = laws::draw_vector<3>(3.0);
      return s;
    });
    EXPECT_TRUE(report.holds()) << report;
  }
}

/// An oscillator without rotational symmetry that promises angular momentum.
struct Wrong : MechanicalSystem<Wrong, 2> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const { return q(0) * q(0) + q(1) * q(1) * 0.25; }
  std::vector<Quantity<Wrong>> quantities() const {
    return {{"angular momentum", {"L"}, Promise::conserved, false, [](const TrajectoryPoint<Wrong>& p, double* out) {
               *out = p.state.object(0) * p.state.momentum(1) - p.state.object(1) * p.state.momentum(0);
             }}};
  }
};

TEST(LoopIntegral, IsTheAreaOfAnEllipse) {
  std::vector<State<Pair<1>>> loop;
  for (int i = 0; i < 15; ++i) {
    const double t = 2 * std::numbers::pi * i / 15;
    loop.push_back({Vector<double, 1>(1 + 2 * std::cos(t)), Vector<double, 1>(3 * std::sin(t))});
  }
  EXPECT_NEAR(loop_integral(loop), -6 * std::numbers::pi, 1e-13);
  loop.pop_back();
  EXPECT_THROW(loop_integral(loop), std::invalid_argument);
}

TEST(LoopIntegral, IsKeptByTheStepsOfASystemAndNotByEulers) {
  Kepler orbit;
  orbit.h = 0.05;
  std::vector<State<Pair<2>>> loop;
  for (int i = 0; i < 41; ++i) {
    const double t = 2 * std::numbers::pi * i / 41;
    loop.push_back({{1 + 0.02 * std::cos(t), 0.01 * std::sin(t)}, {0.01 * std::sin(t), 1 + 0.02 * std::sin(t)}});
  }
  const double area = loop_integral(loop);
  const auto after = carried(orbit, loop, 100);
  ASSERT_TRUE(after.has_value());
  EXPECT_NEAR(loop_integral(*after), area, 1e-12);
  // Explicit Euler.
  for (auto& [q, p] : loop) {
    const Eigen::Vector2d force = -q / std::pow(q.norm(), 3);
    q += orbit.h * p;
    p += orbit.h * force;
  }
  EXPECT_GT(std::abs(loop_integral(loop) - area), 1e-3 * std::abs(area));
}

TEST(MomentumLaw, CatchesAWrongPromise) {
  const auto report = laws::momentum_laws(Wrong{}, [] { return State<Pair<2>>{{1, 0.5}, laws::draw_vector<2>(1.0)}; });
  EXPECT_TRUE(laws::seen_broken(report.law("angular momentum"))) << report;
}

/// On a circle of the plane, with a coordinate z of which L says nothing and the constraint all: dz = x dy - y dx.
struct Winding : System<Winding, Pair<3>, 1, 1> {
  double h = 0.05;
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> step = g.target - g.source;
    return (step(0) * step(0) + step(1) * step(1)) * (0.5 / h);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> step = g.target - g.source;
    const Vector<S, 3> twice = g.source + g.target;
    return Vector<S, 1>(step(2) - (twice(0) * step(1) - twice(1) * step(0)) * 0.5);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>(q(0) * q(0) + q(1) * q(1) - 1.0);
  }
  Step<Winding> first_guess(const State<Pair<3>>& s) const {
    const Vector<double, 3> v = Vector<double, 3>(-s.object(1), s.object(0), 1) * h;
    return {{s.object, s.object + v}, {-s.momentum(2), 0}};
  }
};

TEST(ConstrainedMomentum, IsFiniteWhereTheLagrangianSaysNothingOfWhatConstraintsDetermine) {
  // Along the circle at rate w with multiplier lambda the momentum is w (-y, x, 0) + p_z (y, -x, 1), p_z = -lambda.
  const Winding system;
  const double w = 0.7;
  const double pz = 0.3;
  const Vector<double, 3> q(0.6, 0.8, 0.2);
  const Vector<double, 3> tangent(-q(1), q(0), 0);
  const State<Pair<3>> exact{q, w * tangent - pz * tangent + Vector<double, 3>(0, 0, pz)};
  EXPECT_LT((tangent_momentum(system, exact) - exact.momentum).norm(), 1e-14);
  const State<Pair<3>> across{q, exact.momentum + 0.9 * Vector<double, 3>(q(0), q(1), 0)};
  EXPECT_LT((tangent_momentum(system, across) - exact.momentum).norm(), 1e-14);

  auto integrator = make(system, exact);
  const auto turning = [&](const State<Pair<3>>& s) {
    const auto p = tangent_momentum(system, s);
    return s.object(0) * p(1) - s.object(1) * p(0);
  };
  const double first = turning(integrator.point().state);
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(integrator.advance().converged()) << k;
    ASSERT_NEAR(turning(integrator.point().state), first, 1e-12) << k;
  }
}

}  // namespace
}  // namespace systems_mechanics_tests
