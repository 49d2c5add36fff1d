// The preprocessed discrete Moser-Veselov algorithm: modified moments, closed form, orders, and what it keeps.
#include "../support/allocation_counter.hpp"

#include <lagroid/core/hamiltonian/lagrangian.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>

#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

using namespace lagroid;

namespace solvers_moser_veselov_tests {
namespace {

using Moments = Vector<double, 3>;

constexpr std::array<int, 5> orders{2, 4, 6, 8, 10};
const Moments planar(1, 2, 3);  // the largest that a body of that shape can have: D has a zero
const Moments momentum(0.3, 1.5, 0.4);

State<SO3> state(const Moments& m) {
  State<SO3> s;
  s.momentum = m;
  return s;
}
template <class Solver> FixedStepIntegrator<MoserVeselov> make(const MoserVeselov& system, const State<SO3>& start) {
  return FixedStepIntegrator<MoserVeselov>(system, start, Matrix<double, 3, 3>::Identity(), std::make_unique<Solver>());
}

// ---- modified moments

TEST(ModifiedMoments, BeginAsHairerAndVilmartSay) {
  const Moments inertia(2.3, 0.9, 1.6);
  const double h = 1e-2;
  const double energy = 0.5 * momentum.cwiseQuotient(inertia).dot(momentum);
  const double casimir = 0.5 * momentum.squaredNorm();
  const double sum = inertia.sum();
  const double product = inertia.prod();
  const double s3 = -inertia.cwiseInverse().sum() / 3 * energy + sum / (6 * product) * casimir;
  const double d3 = sum / (6 * product) * energy - casimir / (3 * product);
  const Moments expected = (inertia.cwiseInverse() * (1 + h * h * s3)).array() + h * h * d3;
  EXPECT_LT((preprocess(inertia, momentum, h, 4).cwiseInverse() - expected).norm(), 1e-15);
  EXPECT_EQ(preprocess(inertia, momentum, h, 2), inertia);
}

TEST(ModifiedMoments, OfASteadyRotationAreASine) {
  // 1 / I~ = sin(x) / (h M), x = h M / I, about every axis; its expansion in x.
  const Moments inertia(2.3, 0.9, 1.6);
  const double h = 0.4;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = h * 1.3 / inertia(axis);
    double term = 1;
    double series = 0;
    for (const int order : orders) {
      series += term;
      term *= -x * x / (order * (order + 1));
      const Moments modified = preprocess(inertia, 1.3 * Moments::Unit(axis), h, order);
      EXPECT_NEAR(inertia(axis) / modified(axis), series, 1e-14) << axis << ' ' << order;
    }
  }
}

TEST(ModifiedMoments, DependOnTheTrajectoryOnly) {
  MoserVeselov body;
  body.inertia << 0.9, 2.3, 1.6;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const Moments later = body.reference(state(momentum), attitude, 2.7).momentum;
  ASSERT_GT((later - momentum).norm(), 0.1);
  for (const int order : orders)
    EXPECT_LT((preprocess(body.inertia, later, 0.3, order) - preprocess(body.inertia, momentum, 0.3, order)).norm(),
              1e-13);
  // Nor on the direction of time.
  EXPECT_EQ(preprocess(body.inertia, momentum, -0.3, 10), preprocess(body.inertia, momentum, 0.3, 10));
}

TEST(ModifiedMoments, OfBadInputAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const int order : {-2, 0, 1, 3, 5, 12})
    EXPECT_THROW(preprocess(planar, momentum, 0.1, order), std::invalid_argument);
  for (const double h : {0.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(preprocess(planar, momentum, h, 4), std::invalid_argument);
  EXPECT_THROW(preprocess(Moments(1, 0, 2), momentum, 0.1, 4), std::invalid_argument);
  EXPECT_THROW(preprocess(Moments(1, nan, 2), momentum, 0.1, 4), std::invalid_argument);
  EXPECT_THROW(preprocess(planar, Moments(1, nan, 2), 0.1, 4), std::invalid_argument);
  EXPECT_THROW(preprocess(planar, momentum, 3, 4), std::domain_error);
}

// ---- the step in closed form

/// Bodies of every shape, also of moments that no body has; momenta in general and near an axis; steps up to too long.
class Draws {
 public:
  MoserVeselov system() {
    MoserVeselov out;
    out.modified << 1.2 + uniform(), 1.2 + uniform(), 1.2 + uniform();
    out.h = 2 * (1 + uniform());
    return out;
  }
  Moments momentum() {
    Moments m(uniform(), uniform(), uniform());
    if (++count_ % 3 == 0) m(count_ / 3 % 3) *= 1e-3;
    return m;
  }

 private:
  double uniform() { return distribution_(engine_); }
  std::mt19937 engine_{20261122};
  std::uniform_real_distribution<double> distribution_{-1, 1};
  int count_ = 0;
};

double equation_defect(const MoserVeselov& system, const Moments& m, const Matrix<double, 3, 3>& g) {
  const Moments d = Moments::Constant(0.5 * system.modified.sum()) - system.modified;
  const Matrix<double, 3, 3> moved = g * d.asDiagonal();
  return (moved - moved.transpose() - system.h * SO3::hat(m)).norm();
}

TEST(ClosedForm, IsTheSolutionThatIsContinuousInTheStep) {
  Draws draws;
  int found = 0;
  int none = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const MoserVeselov system = draws.system();
    const State<SO3> start = state(draws.momentum());
    // Newton's iteration, continued in h from h / 64.
    auto followed = make<NewtonStep<MoserVeselov>>(system, start);
    auto closed = make<MoserVeselovStep>(system, start);
    const auto by_newton = followed.advance();
    const auto at_once = closed.advance();
    ASSERT_EQ(at_once.converged(), by_newton.converged()) << sample;
    ++(at_once.converged() ? found : none);
    if (!at_once.converged()) continue;
    const auto& g = closed.point().step.arrow;
    EXPECT_LT(equation_defect(system, start.momentum, g), 1e-13);
    EXPECT_TRUE(system.admissible(g));
    // Near the longest step the solution is as ill-conditioned as it can be.
    EXPECT_LT((g - followed.point().step.arrow).norm(), 1e-7) << sample;
    EXPECT_LT((closed.point().state.momentum - followed.point().state.momentum).norm(), 1e-7) << sample;
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(none, 500);
}

TEST(ClosedForm, OfAnotherSolutionIsNotAdmitted) {
  // About a principal axis sin(angle) = h M / I~ has two.
  MoserVeselov system;
  system.h = 0.5;
  const double angle = std::asin(system.h * 1.2 / 3);
  for (const double other : {angle, std::acos(-1.0) - angle}) {
    const Matrix<double, 3, 3> g = SO3::exp(Moments(0, 0, other));
    EXPECT_LT(equation_defect(system, Moments(0, 0, 1.2), g), 1e-15);
    EXPECT_EQ(system.admissible(g), other == angle);
  }
}

TEST(ClosedForm, ThereIsNoneOfAStepTooLong) {
  MoserVeselov system;
  system.h = 3;
  auto integrator = make<MoserVeselovStep>(system, state(Moments(0, 0, 1.2)));
  EXPECT_EQ(integrator.advance().status, SolveStatus::not_converged);
  EXPECT_EQ(integrator.point().index, 0);
  EXPECT_THROW(MoserVeselov::preprocessed(system.inertia, Moments(0, 0, 1.2), 3, 2), std::domain_error);
  EXPECT_NO_THROW(MoserVeselov::preprocessed(system.inertia, Moments(0, 0, 1.2), 2, 2));
}

TEST(ClosedForm, AllocatesNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  auto integrator = make<MoserVeselovStep>(MoserVeselov::preprocessed(planar, momentum, 0.1, 10), state(momentum));
  const long before = allocation_count();
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_EQ(allocation_count() - before, 0);
}

// ---- orders

struct Errors {
  double momentum;
  double attitude;
};
/// At time `horizon`, by that many steps of a system whose moments are made for steps of that length.
template <class MakeSystem>
Errors errors_at(double horizon, int steps, const Moments& start, const MakeSystem& system) {
  const MoserVeselov body = system(horizon / steps);
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = body.reference(state(start), attitude, horizon);
  auto integrator = make<MoserVeselovStep>(body, state(start));
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(integrator.advance().converged()) << steps;
  return {(integrator.point().state.momentum - exact.momentum).norm(),
          (integrator.point().configuration - attitude).norm()};
}
template <class MakeSystem> Errors measured_orders(const Moments& start, const MakeSystem& system) {
  constexpr double horizon = 12;
  constexpr int steps = 18;
  constexpr double plateau = 2e-12;
  return {laws::measured_order([&](int n) { return errors_at(horizon, n, start, system).momentum; }, steps, plateau),
          laws::measured_order([&](int n) { return errors_at(horizon, n, start, system).attitude; }, steps, plateau)};
}

TEST(MoserVeselov, OrdersInMomentumAndAttitude) {
  for (const Moments& inertia : {planar, Moments(1.1, 0.5, 0.8)})
    for (const int order : orders) {
      const Moments start = momentum * inertia.mean() / 2;
      const auto slope =
          measured_orders(start, [&](double h) { return MoserVeselov::preprocessed(inertia, start, h, order); });
      EXPECT_EQ(MoserVeselov::preprocessed(inertia, start, 0.1, order).traits().order, order);
      EXPECT_NEAR(slope.momentum, order, 0.1) << inertia.transpose();
      EXPECT_NEAR(slope.attitude, order, 0.1) << inertia.transpose();
    }
}

TEST(MoserVeselov, PreprocessedForAnotherTrajectoryIsOfOrderTwo) {
  const Moments other = 1.05 * momentum;
  const auto slope =
      measured_orders(momentum, [&](double h) { return MoserVeselov::preprocessed(planar, other, h, 10); });
  EXPECT_NEAR(slope.momentum, 2, 0.1);
  EXPECT_NEAR(slope.attitude, 2, 0.1);
}

TEST(MoserVeselov, WithMomentsRescaledOnlyIsOfHighOrderInNeither) {
  // 1 / I~ = (1 + s) / I, without d, on which the terms of s from h^4 on rest.
  const auto slope = measured_orders(momentum, [&](double h) {
    MoserVeselov system = MoserVeselov::preprocessed(planar, momentum, h, 10);
    const double s = (1 / system.modified(0) - 1 / system.modified(2)) / (1 / planar(0) - 1 / planar(2)) - 1;
    system.modified = planar / (1 + s);
    return system;
  });
  EXPECT_NEAR(slope.momentum, 4, 0.1);
  EXPECT_NEAR(slope.attitude, 2, 0.1);
}

TEST(MoserVeselov, TurnsASphereExactlyInTheLimit) {
  const Moments sphere(0.7, 0.7, 0.7);
  const double h = 0.1;
  const auto system = MoserVeselov::preprocessed(sphere, momentum, h, 10);
  auto integrator = make<MoserVeselovStep>(system, state(momentum));
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(integrator.advance().converged());
  const Matrix<double, 3, 3> exact = SO3::exp(Moments(100 * h * momentum / 0.7));
  EXPECT_LT((integrator.point().configuration - exact).norm(), 1e-11);
}

// ---- what the step keeps

TEST(MoserVeselov, EnergyAndSpatialMomentumAreConserved) {
  for (const int order : orders) {
    const auto system = MoserVeselov::preprocessed(Moments(1.1, 0.5, 0.8), momentum, 0.1, order);
    const auto report = laws::momentum_laws(system, [] { return state(laws::draw_vector<3>(2.0)); });
    EXPECT_TRUE(report.holds()) << report;
  }
}

/// The largest deviation of the energy and of A M, relative to their size.
template <class Solver> Errors drift(const MoserVeselov& system, long steps) {
  auto integrator = make<Solver>(system, state(momentum));
  Errors out{0, 0};
  for (long k = 0; k < steps; ++k) {
    EXPECT_TRUE(integrator.advance().converged());
    const auto& point = integrator.point();
    const double energy = system.energy(state(momentum));
    out.momentum =
        std::max(out.momentum, (point.configuration * point.state.momentum - momentum).norm() / momentum.norm());
    out.attitude = std::max(out.attitude, std::abs(system.energy(point.state) / energy - 1));
  }
  return out;
}

TEST(MoserVeselov, KeepsThemOverAHundredThousandSteps) {
  constexpr long steps = 100'000;
  const double walk = 20 * std::numeric_limits<double>::epsilon() * std::sqrt(double(steps));
  for (const int order : orders) {
    const auto kept = drift<MoserVeselovStep>(MoserVeselov::preprocessed(planar, momentum, 0.3, order), steps);
    EXPECT_LT(kept.momentum, walk) << order;
    EXPECT_LT(kept.attitude, walk) << order;
  }
}

TEST(MoserVeselov, KeepsNoEnergyOfMomentsThatAreNotAffine) {
  MoserVeselov system = MoserVeselov::preprocessed(planar, momentum, 0.3, 10);
  system.modified(1) *= 1.01;
  EXPECT_GT(drift<MoserVeselovStep>(system, 1000).attitude, 1e-4);
}

TEST(MoserVeselov, ReturnsByStepsBack) {
  auto system = MoserVeselov::preprocessed(planar, momentum, 0.3, 8);
  auto there = make<MoserVeselovStep>(system, state(momentum));
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(there.advance().converged());
  system.h = -system.h;
  FixedStepIntegrator<MoserVeselov> back(system, there.point().state, there.point().configuration,
                                         std::make_unique<MoserVeselovStep>());
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(back.advance().converged());
  EXPECT_LT((back.point().state.momentum - momentum).norm(), 1e-13);
  EXPECT_LT((back.point().configuration - Matrix<double, 3, 3>::Identity()).norm(), 1e-13);
}

TEST(MoserVeselov, IsPoisson) {
  const auto system = MoserVeselov::preprocessed(planar, momentum, 0.3, 8);
  const auto defect = [&](const Step<MoserVeselov>& step) {
    return poisson_defect(GeneratedSubmanifold<MoserVeselov>(system).tangent(step));
  };
  EXPECT_LT(defect(system.first_guess(state(momentum))), 1e-13);
}

}  // namespace
}  // namespace solvers_moser_veselov_tests
