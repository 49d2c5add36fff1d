// One implicit step: Newton's status in every outcome, no allocation, agreement with Ceres, scaling.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>
#include <lagroid/systems/rotations/driven_body.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <vector>

using namespace lagroid;

namespace step_steps_tests {
namespace {

using G = PlateBall::GroupoidType;

State<G> plate_state() {
  State<G> s;
  std::get<0>(s.object) << 0.3, -0.2;
  s.momentum << 0.9, 0.2, 0.6, -0.4, 0.8;
  return s;
}

template <class Sys>
FixedStepIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& state,
                              StepMethod method = StepMethod::newton) {
  return FixedStepIntegrator<Sys>(system, state, system.groupoid.unit(state.object), make_step_solver(system, method));
}

template <class Sys> void expect_no_allocation(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  auto integrator = make(system, state);
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(integrator.advance().converged());
  const long before = allocation_count();
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(NewtonStep, AllocatesNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  expect_no_allocation(PlateBall{}, plate_state());
  State<SO3> body;
  body.momentum << 0.3, 1.5, 0.4;
  expect_no_allocation(RigidBody{}, body);
  expect_no_allocation(Kepler{}, State<Pair<2>>{{0.5, 0}, {0, 1.7}});
  RollingBall ball;
  ball.plate_rate = 1.3;
  expect_no_allocation(ball, ball.rolling({0.3, -0.2}, {0.4, 0.1}, 0.7));
  expect_no_allocation(ChaplyginSleigh{}, ChaplyginSleigh{}.sliding(1, -0.6));
  expect_no_allocation(DrivenBody{}, body);
  expect_no_allocation(SphericalPendulum{}, State<Pair<3>>{{0.6, 0, -0.8}, {0, 0.5, 0}});
}

TEST(NewtonStep, TheAllocationCounterCounts) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const long before = allocation_count();
  void* volatile block = std::malloc(16);
  const long after = allocation_count();
  std::free(block);
  EXPECT_EQ(after - before, 1);
}

template <class Sys> void expect_agreement(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  auto newton = make(system, state);
  auto ceres = make(system, state, StepMethod::ceres);
  for (int k = 0; k < 20; ++k) {
    ASSERT_TRUE(newton.advance().converged());
    const auto report = ceres.advance();
    ASSERT_TRUE(report.converged()) << to_string(report.status) << ' ' << report.residual << ' '
                                    << report.roundoff_ratio;
  }
  const auto& groupoid = system.groupoid;
  const auto& a = newton.point();
  const auto& b = ceres.point();
  EXPECT_LT((groupoid.coordinates_of_arrow(a.configuration) - groupoid.coordinates_of_arrow(b.configuration)).norm(),
            1e-12);
  EXPECT_LT((a.state.momentum - b.state.momentum).norm(), 1e-12);
  if constexpr (Sys::constraints > 0) {
    EXPECT_LT((a.step.multipliers - b.step.multipliers).norm(), 1e-11);
  }
}

TEST(CeresStep, AgreesWithNewton) {
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    PlateBall system;
    system.plate_rate = 0.7;
    system.spin = 0.4;
    system.rotation = form;
    expect_agreement(system, plate_state());
  }
  State<SO3> body;
  body.momentum << 0.3, 1.5, 0.4;
  expect_agreement(RigidBody{}, body);
  expect_agreement(Kepler{}, State<Pair<2>>{{0.5, 0}, {0, 1.7}});
  expect_agreement(SphericalPendulum{}, State<Pair<3>>{{0.6, 0, -0.8}, {0, 0.5, 0}});
}

TEST(NewtonStep, ReportsNotFinite) {
  State<G> state = plate_state();
  state.momentum(2) = std::numeric_limits<double>::quiet_NaN();
  auto integrator = make(PlateBall{}, state);
  EXPECT_EQ(integrator.advance().status, SolveStatus::not_finite);
  EXPECT_EQ(integrator.point().index, 0);
  auto ceres = make(PlateBall{}, state, StepMethod::ceres);
  EXPECT_EQ(ceres.advance().status, SolveStatus::not_finite);
}

/// L does not depend on the second coordinate: not regular.
struct Degenerate : System<Degenerate, Pair<2>> {
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const S d = g.target(0) - g.source(0);
    return d * d * 0.5;
  }
};

TEST(NewtonStep, ReportsSingular) {
  const Degenerate system;
  FixedStepIntegrator<Degenerate> integrator(system, {{0, 0}, {1, 1}}, {{0, 0}, {0, 0}},
                                             std::make_unique<NewtonStep<Degenerate>>());
  EXPECT_EQ(integrator.advance().status, SolveStatus::singular);
  const double condition = regularity_condition(system, {{{0, 0}, {1, 0}}, {}});
  EXPECT_FALSE(condition < 1e15);
}

/// L = sqrt(1 + d^2), whose momenta are all below one.
struct Bounded : System<Bounded, Pair<1>> {
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    using std::sqrt;
    const S d = g.target(0) - g.source(0);
    return sqrt(d * d + 1.0);
  }
};

TEST(NewtonStep, ReportsStagnationWhereThereIsNoSolution) {
  const State<Pair<1>> start{Vector<double, 1>(0.0), Vector<double, 1>(2.0)};
  FixedStepIntegrator<Bounded> integrator({}, start, {start.object, start.object},
                                          std::make_unique<NewtonStep<Bounded>>());
  const auto report = integrator.advance();
  EXPECT_EQ(report.status, SolveStatus::stagnated);
  EXPECT_GE(report.residual, 1);
  EXPECT_EQ(integrator.point().index, 0);
  EXPECT_EQ(integrator.point().state.momentum, start.momentum);
}

TEST(NewtonStep, ReportsLeftDomainWhereAllSolutionsAreOfAnotherBranch) {
  // The trace form reaches |w| < 1 only: a momentum that asks for more has no step.
  PlateBall system;
  system.h = 1;
  State<G> state = plate_state();
  state.momentum << 40, 30, 0.1, 0.1, 0.1;
  auto integrator = make(system, state);
  EXPECT_EQ(integrator.advance().status, SolveStatus::left_domain);
  EXPECT_EQ(integrator.point().index, 0);
  EXPECT_EQ(integrator.point().state.momentum, state.momentum);
}

TEST(NewtonStep, RejectsTheOtherRootsOfTheTraceForm) {
  // The trace form has several roots a step; from a guess near another one the solve says so instead of returning it.
  PlateBall system;
  system.h = 0.05;
  const auto state = plate_state();
  NewtonStep<PlateBall> newton;
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  int wrong_branch = 0;
  int found = 0;
  StepSolution<PlateBall> right;
  right.step = system.first_guess(state);
  ASSERT_TRUE(newton.solve(system, state, right).converged());
  for (int k = 0; k < 300; ++k) {
    StepSolution<PlateBall> solution;
    const Vector<double, 3> w(2 * normal(generator), 2 * normal(generator), 2 * normal(generator));
    const auto& q = std::get<0>(state.object);
    solution.step = {{PairArrow<double, 2>{q, q}, SO3::exp(w)},
                     {3 * normal(generator), normal(generator), normal(generator)}};
    const auto report = newton.solve(system, state, solution);
    if (report.status == SolveStatus::left_domain) {
      ++wrong_branch;
      EXPECT_LE(std::get<1>(solution.step.arrow).trace(), 1);
    }
    if (report.converged()) {
      ++found;
      EXPECT_LT((solution.step.multipliers - right.step.multipliers).norm(), 1e-9) << "a second admissible root";
    }
  }
  EXPECT_GT(wrong_branch, 10);
  EXPECT_GT(found, 10);
}

/// The condition number of the equilibrated matrix of T F+ at a step, by differences: F+ and phi as the source moves.
double condition_of_plus(const PlateBall& system, const Step<PlateBall>& step) {
  constexpr double e = 1e-6;
  const Vector<double, 5> still = Vector<double, 5>::Zero();
  const auto at = [&](const Vector<double, 8>& x) {
    const Step<PlateBall> moved{system.groupoid.translate(Vector<double, 5>(x.head<5>()), step.arrow, still),
                                step.multipliers + x.tail<3>()};
    Vector<double, 8> out;
    out << legendre_plus(system, moved).momentum, constraint_values(system, moved.arrow);
    return out;
  };
  Matrix<double, 8, 8> j;
  for (int i = 0; i < 8; ++i) {
    const Vector<double, 8> x = e * Vector<double, 8>::Unit(i);
    j.col(i) = (at(x) - at(Vector<double, 8>(-x))) / (2 * e);
  }
  const Matrix<double, 8, 8> scaled = Scaling<8>::equilibrate(j).apply(j);
  const auto sigma = Eigen::JacobiSVD<Matrix<double, 8, 8>>(scaled).singularValues().eval();
  return sigma(0) / sigma(7);
}

TEST(Regularity, ConditionIsTheSameForEveryStep) {
  // And for both ends of it, [G] Corollary 3.4.
  std::vector<double> conditions;
  for (const double h : {1e-1, 1e-3, 1e-5}) {
    PlateBall system;
    system.h = h;
    auto integrator = make(system, plate_state());
    ASSERT_TRUE(integrator.advance().converged());
    conditions.push_back(regularity_condition(system, integrator.point().step));
    EXPECT_NEAR(condition_of_plus(system, integrator.point().step) / conditions.back(), 1, 1e-3) << h;
  }
  EXPECT_LT(conditions[0], 10);
  for (const double condition : conditions) EXPECT_NEAR(condition / conditions[0], 1, 0.5);
}

TEST(FixedStepIntegrator, LegendreTransformsMeetAtTheObjects) {
  PlateBall system;
  system.plate_rate = 0.7;
  auto integrator = make(system, plate_state());
  auto before = plate_state();
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(integrator.advance().converged());
    const auto& step = integrator.point().step;
    const auto minus = legendre_minus(system, step);
    EXPECT_LT((minus.momentum - before.momentum).norm(), 1e-12) << k;
    EXPECT_LT((std::get<0>(minus.object) - std::get<0>(before.object)).norm(), 1e-12) << k;
    before = legendre_plus(system, step);
    EXPECT_LT((integrator.point().state.momentum - before.momentum).norm(), 1e-12) << k;
  }
}

TEST(FixedStepIntegrator, LargeTurnsAndSmallBalls) {
  struct Case {
    double radius, rate, spin, h;
    RotationForm form;
  };
  for (const Case c : {Case{1, 0.7, 29, 0.1, RotationForm::exponential}, Case{1, 0.7, 29, 0.1, RotationForm::cayley},
                       Case{1, 0.2, 14.5, 0.2, RotationForm::cayley}, Case{0.02, 0.7, 0.4, 0.002, RotationForm::trace},
                       Case{1, 5, 0.4, 0.05, RotationForm::trace}, Case{1, 0, 0.97, 1, RotationForm::trace}}) {
    PlateBall system;
    system.radius = c.radius;
    system.plate_rate = c.rate;
    system.spin = c.spin;
    system.h = c.h;
    system.rotation = c.form;
    State<G> state = plate_state();
    state.momentum.tail<3>() *= std::min(1.0, c.radius);
    if (c.h == 1) state.momentum << 0.01, 0.02, 0.01, 0.02, 0.3;
    auto integrator = make(system, state);
    for (int k = 0; k < 20; ++k) {
      const auto report = integrator.advance();
      ASSERT_TRUE(report.converged()) << c.spin << ' ' << k << ' ' << to_string(report.status);
      EXPECT_LT(constraint_values(system, integrator.point().step.arrow).norm(), 1e-13);
    }
  }
}

}  // namespace
}  // namespace step_steps_tests
