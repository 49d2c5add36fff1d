// Plate-ball initial-value problems: reference numbers, order, conserved momenta.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include "../support/broken.hpp"
#include "../support/plate_ball_cases.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace systems_plate_ball_initial_tests {
namespace {

using G = PlateBall::GroupoidType;

FixedStepIntegrator<PlateBall> make(const PlateBall& system, const State<G>& state) {
  return FixedStepIntegrator<PlateBall>(system, state, system.groupoid.unit(state.object),
                                        std::make_unique<NewtonStep<PlateBall>>());
}

class InitialValue : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(InitialValue, EndsAtTheReference) {
  const auto [id, form] = GetParam();
  const auto c = cases::find(id);
  const auto expected = c.at("results").at(form);
  const PlateBall system = cases::system(c, form);
  State<G> state;
  std::get<0>(state.object) << c.at("x0").get<double>(), c.at("y0").get<double>();
  state.momentum << c.at("px0").get<double>(), c.at("py0").get<double>(), cases::vector<3>(c.at("M0"));
  auto integrator = make(system, state);
  double cost = 0;
  const int steps = c.at("N").get<int>();
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(integrator.advance().converged()) << k;
    cost += system.lagrangian(integrator.point().step.arrow);
    if (k == 0) {
      const auto& step = integrator.point().step;
      EXPECT_NEAR(std::get<0>(step.arrow).target(0), cases::number(expected.at("step1").at("x")), 1e-12);
      EXPECT_LT((step.multipliers - cases::vector<3>(expected.at("step1").at("lambda123"))).norm(), 1e-11);
      EXPECT_LT(
          (SO3::log(std::get<1>(step.arrow)) - cases::vector<3>(expected.at("step1").at("g1_rotation_vector"))).norm(),
          1e-13);
      EXPECT_NEAR(system.energy(step), cases::number(expected.at("E_first")), 1e-11);
    }
  }
  const auto& point = integrator.point();
  const auto& q = std::get<0>(point.state.object);
  const double size = q.norm();
  EXPECT_NEAR(q(0), cases::number(expected.at("x_N")), 1e-11 * size);
  EXPECT_NEAR(q(1), cases::number(expected.at("y_N")), 1e-11 * size);
  EXPECT_LT((std::get<1>(point.configuration) - cases::matrix(expected.at("A_N"))).norm(), 1e-11);
  EXPECT_LT((point.state.momentum.tail<3>() - cases::vector<3>(expected.at("M_N"))).norm(), 1e-11);
  EXPECT_LT((point.state.momentum.head<2>() - cases::vector<2>(expected.at("p_N"))).norm(), 1e-11);
  EXPECT_NEAR(cost, cases::number(expected.at("cost")), 1e-11 * cost);
  EXPECT_NEAR(system.energy(point.step), cases::number(expected.at("E_last")), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Cases, InitialValue,
                         ::testing::Combine(::testing::Values("P1-ivp-generic", "P4-ivp-long-flat"),
                                            ::testing::Values("trace", "exp", "cay")),
                         [](const auto& test) {
                           return std::get<0>(test.param).substr(0, 2) + "_" + std::get<1>(test.param);
                         });

State<G> generic_state() {
  State<G> state;
  std::get<0>(state.object) << 0.3, -0.2;
  state.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  return state;
}

TEST(Reference, AgreesWithTheCaseFile) {
  const auto c = cases::find("P1-ivp-generic");
  PlateBall system = cases::system(c, "exp");
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto end = system.reference(generic_state(), attitude, 4.0);
  EXPECT_NEAR(std::get<0>(end.object)(0), c.at("continuous").at("x").get<double>(), 1e-11);
  EXPECT_NEAR(std::get<0>(end.object)(1), c.at("continuous").at("y").get<double>(), 1e-11);
}

class Order : public ::testing::TestWithParam<RotationForm> {};

TEST_P(Order, IsTwo) {
  PlateBall system;
  system.plate_rate = 0.7;
  system.spin = 0.4;
  system.rotation = GetParam();
  constexpr double horizon = 2;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(generic_state(), attitude, horizon);
  std::vector<double> errors;
  for (const int steps : {100, 200, 400}) {
    system.h = horizon / steps;
    auto integrator = make(system, generic_state());
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(integrator.advance().converged());
    const auto& p = integrator.point();
    errors.push_back((std::get<0>(p.state.object) - std::get<0>(exact.object)).norm() +
                     (p.state.momentum - exact.momentum).norm() + (std::get<1>(p.configuration) - attitude).norm());
  }
  for (int i = 0; i + 1 < int(errors.size()); ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Forms, Order,
                         ::testing::Values(RotationForm::trace, RotationForm::exponential, RotationForm::cayley));

TEST(Momenta, AreConservedFromRandomStates) {
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley})
    for (const double rate : {0.0, 0.6}) {
      PlateBall system;
      system.h = 0.02;
      system.plate_rate = rate;
      system.spin = 0.4;
      system.rotation = form;
      const auto report = laws::momentum_laws(system, [] {
        State<G> state;
        std::get<0>(state.object) = laws::draw_vector<2>(1.0);
        state.momentum = laws::draw_vector<5>(1.0);
        return state;
      });
      EXPECT_TRUE(report.holds()) << report;
    }
}

/// Plate-ball with a quadratic potential that is not rotation-invariant: J is promised, and not kept.
struct Tilted : System<Tilted, PlateBall::GroupoidType, 3> {
  PlateBall base;
  double h = 0.05;
  template <class S> S lagrangian(const Arrow<S>& g) const {
    return base.lagrangian(g) - std::get<0>(g).source(0) * (0.5 * h) - std::get<0>(g).target(0) * (0.5 * h);
  }
  template <class S> Vector<S, 3> constraint(const Arrow<S>& g) const { return base.constraint(g); }
  std::vector<Quantity<Tilted>> quantities() const {
    return {{"J", {"J"}, Promise::conserved, false, [](const TrajectoryPoint<Tilted>& p, double* out) {
               const auto& q = std::get<0>(p.state.object);
               *out = q(0) * p.state.momentum(1) - q(1) * p.state.momentum(0) - p.state.momentum(4);
             }}};
  }
};

TEST(Momenta, ABrokenSymmetryIsCaught) {
  const auto report = laws::momentum_laws(Tilted{}, [] {
    State<G> state;
    std::get<0>(state.object) << 0.3, 0.4;
    state.momentum = laws::draw_vector<5>(0.5);
    return state;
  });
  EXPECT_TRUE(laws::seen_broken(report.law("J"))) << report;
}

TEST(Energy, CayleyWithoutPlateAndSpinKeepsItToRoundOff) {
  PlateBall system;
  system.h = 0.05;
  system.rotation = RotationForm::cayley;
  auto integrator = make(system, generic_state());
  ASSERT_TRUE(integrator.advance().converged());
  const double first = system.energy(integrator.point().step);
  for (int k = 0; k < 2000; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    EXPECT_NEAR(system.energy(integrator.point().step), first, 1e-12);
  }
}

TEST(Elastica, CurvatureIsMinusL3OverRSquaredSpeed) {
  // For Omega = c = 0 the contact point follows an Euler elastica (design: curvature -l3 / (r^2 speed)).
  PlateBall system;
  system.h = 1e-3;
  system.radius = 0.8;
  system.rotation = RotationForm::exponential;
  auto integrator = make(system, generic_state());
  Step<PlateBall> previous;
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    const auto& step = integrator.point().step;
    if (k > 0) {
      const auto& a = std::get<0>(previous.arrow);
      const auto& b = std::get<0>(step.arrow);
      const Vector<double, 2> u = (a.target - a.source) / system.h;
      const Vector<double, 2> v = (b.target - b.source) / system.h;
      const double speed = 0.5 * (u.norm() + v.norm());
      const double turning = (u(0) * v(1) - u(1) * v(0)) / (speed * speed);
      const double l3 = 0.5 * (previous.multipliers(2) + step.multipliers(2));
      EXPECT_NEAR(turning / (system.h * speed), -l3 / (system.radius * system.radius * speed), 1e-4);
    }
    previous = step;
  }
}

}  // namespace
}  // namespace systems_plate_ball_initial_tests
