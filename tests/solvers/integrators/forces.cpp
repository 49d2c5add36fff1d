// Discrete forces: order, energy, derivatives, the Lagrange-d'Alembert principle, and what breaks it.
#include "../../support/broken.hpp"
#include "../../support/draws.hpp"
#include "../../support/integrating.hpp"
#include "../../support/on_a_sphere.hpp"

#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/solvers/testing/dalembert_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace integrators_forces_tests {
namespace {

// Systems without forces are as they were.
static_assert(Variational<Pendulum> && Variational<RigidBody> && Variational<PlateBall>);
static_assert(Forced<DampedPendulum> && !Variational<DampedPendulum> && !Nonholonomic<DampedPendulum>);

const State<Pair<1>> swing{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
const State<SO3> tumble{{}, {0.3, 1.5, 0.4}};

DrivenBody driven(RotationMap map = RotationMap::exponential) {
  DrivenBody body;
  body.torque << 0.1, 0.2, -0.05;
  body.rotation = map;
  return body;
}

/// All of the impulse at the source.
struct OneSided : DampedPendulum {
  template <class S, class T> Forces<S, 1> forces(const PairArrow<S, 1>& g, const T& /*step*/) const {
    return {(g.target - g.source) * -damping, Vector<S, 1>(S(0))};
  }
  template <class S> Forces<S, 1> forces(const PairArrow<S, 1>& g) const { return forces(g, h); }
};

/// Derivatives by hand that forget the force.
struct Forgetful : DampedPendulum {
  TwoSided<1, 0> two_sided(const PairArrow<double, 1>& g, const Multipliers& lambda) const {
    return automatic_two_sided(static_cast<const Pendulum&>(*this), g, lambda);
  }
};

template <class Sys> double pendulum_order(const Sys& system) {
  const auto exact = system.reference(swing, 10.0);
  return measured_order(system, swing, 10.0, 200, [&](const Sys&, const TrajectoryPoint<Sys>& end) {
    return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
  });
}

TEST(Forces, DampedPendulumIsOfOrderTwo) {
  DampedPendulum system;
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    system.quadrature = quadrature;
    EXPECT_NEAR(pendulum_order(system), 2, 0.02);
  }
}

TEST(BrokenForces, AtOneEndAloneAreOfOrderOne) { EXPECT_NEAR(pendulum_order(OneSided{}), 1, 0.05); }

TEST(Forces, DrivenBodyIsOfOrderTwoInMomentumAndAttitude) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
    const auto exact = driven().reference(tumble, attitude, 10.0);
    const double order =
        measured_order(driven(map), tumble, 10.0, 200, [&](const DrivenBody&, const TrajectoryPoint<DrivenBody>& end) {
          return (end.configuration - attitude).norm() + (end.state.momentum - exact.momentum).norm();
        });
    EXPECT_NEAR(order, 2, 0.02);
  }
}

TEST(Forces, BesideAnObjectConstraintAreOfOrderTwo) {
  const State<Pair<3>> start{{0.6, 0, -0.8}, {0, 0.9, 0}};
  const auto exact = Viscous{}.reference(start, 3.0);
  const double order = measured_order(Viscous{}, start, 3.0, 100, [&](const Viscous& s, const auto& end) {
    return (end.state.object - exact.object).norm() + (reported_momentum(s, end) - exact.momentum).norm();
  });
  EXPECT_NEAR(order, 2, 0.05);
}

TEST(Forces, EnergyDecaysAtTheRateOfTheContinuousPendulum) {
  // Small swings: q = A exp(-c t / 2) cos(w t + s), so that the energy above rest falls as exp(-c t) once the ripple of
  // 2 w t is the same at both ends.
  const double c = 0.1;
  const double horizon = 12 * M_PI / std::sqrt(1 - c * c / 4);
  const State<Pair<1>> start{Vector<double, 1>(1e-4), Vector<double, 1>(0.0)};
  const auto rate_error = [&](const DampedPendulum& s, const TrajectoryPoint<DampedPendulum>& end) {
    const double q = end.state.object(0);
    const double p = end.state.momentum(0);
    const double decayed = (p * p + q * q) / 1e-8;  // of the linear oscillator: 1 + cos(1e-4) would cancel
    EXPECT_EQ(s.damping, c);
    return std::abs(-std::log(decayed) / horizon - c);
  };
  EXPECT_NEAR(measured_order(DampedPendulum{}, start, horizon, 300, rate_error), 2, 0.1);
}

/// The largest deviation of the first quantity over a run.
template <class Sys>
double largest_drift(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps) {
  const auto quantity = system.quantities().front();
  auto integrator = integrator_from(system, start);
  double first = 0;
  quantity.evaluate(integrator.point(), &first);
  double largest = 0;
  for (long k = 0; k < steps; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    double now = 0;
    quantity.evaluate(integrator.point(), &now);
    largest = laws::worst({largest, std::abs(now - first)});
  }
  return largest;
}

TEST(Forces, EnergyLessWorkStaysInABandOfOrderTwo) {
  const auto slope = [](auto system, const auto& start) {
    system.h = 0.05;
    const double coarse = largest_drift(system, start, 2000);
    system.h = 0.025;
    return std::log2(coarse / largest_drift(system, start, 4000));
  };
  EXPECT_NEAR(slope(DampedPendulum{}, swing), 2, 0.1);
  EXPECT_NEAR(slope(driven(), tumble), 2, 0.1);
}

TEST(BrokenForces, EnergyLessWorkSeesAForceThatIsForgotten) {
  Forgetful system;
  system.h = 0.05;
  const auto quantity = energy_balance(system);
  auto integrator = integrator_from(system, swing);
  double first = 0;
  double now = 0;
  quantity.evaluate(integrator.point(), &first);
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    quantity.evaluate(integrator.point(), &now);
  }
  EXPECT_GT(std::abs(now - first), 0.1);
}

TEST(Forces, MixedDerivativeIsThatOfTheGradient) {
  const auto compare = [](const auto& system, const auto& step) {
    using Sys = std::decay_t<decltype(system)>;
    using V = Vector<double, Sys::dimension>;
    const auto d = automatic_two_sided(system, step.arrow, step.multipliers);
    const auto g = automatic_gradients(system, step.arrow, step.multipliers);
    EXPECT_LT((d.source_gradient - g.source_gradient).norm() + (d.target_gradient - g.target_gradient).norm(), 1e-12);
    constexpr double e = 1e-5;
    for (int j = 0; j < Sys::dimension; ++j) {
      const auto at = [&](double x) -> V {
        return automatic_gradients(system, system.groupoid.extend(step.arrow, V(x * V::Unit(j))), step.multipliers)
            .source_gradient;
      };
      EXPECT_LT((d.mixed.col(j) - (at(e) - at(-e)) / (2 * e)).norm(), 1e-8 * (1 + d.mixed.norm())) << j;
    }
  };
  compare(DampedPendulum{}, Step<DampedPendulum>{{Vector<double, 1>(0.4), Vector<double, 1>(0.5)}, {}});
  compare(driven(), Step<DrivenBody>{SO3::exp(Vector<double, 3>(0.1, -0.2, 0.3)), {}});
  compare(driven(RotationMap::cayley), Step<DrivenBody>{SO3::exp(Vector<double, 3>(0.1, -0.2, 0.3)), {}});
}

TEST(Forces, DerivativesAgreeWithNestedDuals) {
  const auto pendulum = laws::derivative_laws(DampedPendulum{}, [] { return draw_step(DampedPendulum{}, 0.5); });
  EXPECT_TRUE(pendulum.holds()) << pendulum;
  const auto body = laws::derivative_laws(driven(), [] { return draw_step(driven(), 0.5); });
  EXPECT_TRUE(body.holds()) << body;
}

TEST(BrokenForces, DerivativesThatForgetThem) {
  const auto report = laws::derivative_laws(Forgetful{}, [] { return draw_step(Forgetful{}, 0.5); });
  EXPECT_TRUE(laws::seen_broken(report.law("analytic derivatives"))) << report;
}

TEST(Forces, NoVirtualWork) {
  const auto pendulum = laws::dalembert_laws(DampedPendulum{}, [] {
    return State<Pair<1>>{laws::draw_vector<1>(2.0), laws::draw_vector<1>(1.0)};
  });
  EXPECT_TRUE(pendulum.holds()) << pendulum;
  const auto body = laws::dalembert_laws(driven(), [] { return State<SO3>{{}, laws::draw_vector<3>(2.0)}; });
  EXPECT_TRUE(body.holds()) << body;
}

TEST(Forces, BesideAnObjectConstraintDoNoVirtualWork) {
  const auto report = laws::dalembert_laws(Viscous{}, draw_on_the_sphere);
  EXPECT_TRUE(report.holds()) << report;
}

/// Derivatives by hand with a tension that is not along the rod.
struct Leaning : Viscous {
  TwoSided<3, 1> two_sided(const PairArrow<double, 3>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(static_cast<const Viscous&>(*this), g, lambda);
    const Vector<double, 3> normal = d.constraint_source.col(0) + Vector<double, 3>(0.3, 0, 0);
    d.source_gradient += (normal - d.constraint_source.col(0)) * lambda(0);
    d.constraint_source.col(0) = normal;
    return d;
  }
};
TEST(BrokenForces, ATensionThatIsNotAlongTheRodDoesVirtualWork) {
  const auto report = laws::dalembert_laws(Leaning{}, draw_on_the_sphere);
  EXPECT_FALSE(report.law("no virtual work").holds()) << report;
  EXPECT_FALSE(report.law("reported momenta keep the constraints").holds()) << report;
}

TEST(BrokenForces, VirtualWorkOfAForceThatIsForgotten) {
  const auto report = laws::dalembert_laws(Forgetful{}, [] {
    return State<Pair<1>>{laws::draw_vector<1>(2.0), Vector<double, 1>(2.0)};
  });
  EXPECT_TRUE(laws::seen_broken(report.law("no virtual work"))) << report;
}

TEST(Balance, MustSeeEveryPoint) {
  const DampedPendulum system;
  const auto quantity = energy_balance(system);
  auto integrator = integrator_from(system, swing);
  double value = 0;
  quantity.evaluate(integrator.point(), &value);
  ASSERT_TRUE(integrator.advance().converged());
  quantity.evaluate(integrator.point(), &value);
  const double once = value;
  quantity.evaluate(integrator.point(), &value);
  EXPECT_EQ(value, once) << "the same point again changes nothing";
  ASSERT_TRUE(integrator.advance().converged());
  ASSERT_TRUE(integrator.advance().converged());
  quantity.evaluate(integrator.point(), &value);
  EXPECT_TRUE(std::isnan(value)) << "a point was left out";
}

}  // namespace
}  // namespace integrators_forces_tests
