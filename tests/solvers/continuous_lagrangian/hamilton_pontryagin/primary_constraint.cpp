// Lagrangians that are linear in the velocities: p = theta(q) at nodes, and no parasites.
#include <lagroid/solvers/galerkin/primary_constraint.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/reference.hpp>

#include "energy_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace lagroid;
using namespace lagroid::subjects;

namespace hamilton_pontryagin_primary_constraint_tests {
namespace {

/// Predator and prey, (ln y / x x' - ln x / y y') / 2 - H.
struct Prey : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    using std::log;
    const S x = log(q(0));
    const S y = log(q(1));
    return (y / q(0) * v(0) - x / q(1) * v(1)) * 0.5 - (x - q(0) + y - q(1));
  }
};
Vector<double, 2> prey_end(const Vector<double, 2>& start, double t) {
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy << y(0) * (1 - y(1)), y(1) * (y(0) - 1); };
  return integrate_reference(rates, start, t);
}

TEST(PrimaryConstraint, PredatorAndPreyForAHundredThousandSteps) {
  const Vector<double, 2> start(1.5, 0.8);
  for (const auto& [first, last] : {energy_errors(PrimaryConstraintStep(Midpoint<Prey>{}), start, 0.1, 100000),
                                    energy_errors(PrimaryConstraintStep(Trapezoidal<Prey>{}), start, 0.1, 100000)}) {
    EXPECT_GT(first, 1e-7);
    EXPECT_LT(last, 1.01 * first);
  }
}

// The discrete Euler-Lagrange equation alone is started as well, and its parasites grow.
TEST(PrimaryConstraint, WithoutItParasitesGrow) {
  const Trapezoidal<Prey> rule{Prey{}, 0.1};
  const PrimaryConstraintStep<Trapezoidal<Prey>> by(rule);
  // D2 L(q0, q1) + D1 L(q1, q2) = 0 from two nodes of the projected motion.
  auto z = by.on(Vector<double, 2>(1.5, 0.8));
  Vector<double, 2> before = z.object;
  ASSERT_EQ(by.step(z, 0.1), SolveStatus::converged);
  Vector<double, 2> now = z.object;
  const double energy = by.energy(now);
  double worst = 0;
  for (int k = 0; k < 100000 && worst < 0.1; ++k) {
    const auto residual = [&]<class U>(const Vector<U, 2>& next, const Vector<U, 4>& last) {
      const Vector<U, 2> from = part<0, 2>(last);
      const Vector<U, 2> at = part<2, 2>(last);
      const auto sum = [&](const Vector<Dual<U>, 2>& q) {
        return Dual<U>(rule.lagrangian(PairArrow<Dual<U>, 2>{constants<Dual<U>>(from), q}) +
                       rule.lagrangian(PairArrow<Dual<U>, 2>{q, constants<Dual<U>>(next)}));
      };
      return gradient_of(sum, at);
    };
    const Vector<double, 2> next =
        solve_implicit<double, 2, 4>(residual, Vector<double, 2>(2 * now - before), joined(before, now));
    if (!next.allFinite()) {
      worst = 1;
      break;
    }
    before = now;
    now = next;
    worst = std::max(worst, std::abs(by.energy(now) - energy));
  }
  const auto [first, last] = energy_errors(by, Vector<double, 2>(1.5, 0.8), 0.1, 2000);
  EXPECT_GT(worst, 10 * std::max(first, last));
}

TEST(PrimaryConstraint, OrdersTwoAndFour) {
  const Vector<double, 2> start(1.5, 0.8);
  const PrimaryConstraintStep<Midpoint<Prey>> by(Midpoint<Prey>{});
  laws::OrderProblem problem;
  problem.exact = prey_end(start, 5);
  const auto end = [&](auto&& take) {
    return [&, take](int steps) {
      auto z = by.on(start);
      for (int k = 0; k < steps; ++k) EXPECT_EQ(take(z, 5.0 / steps), SolveStatus::converged);
      return Eigen::VectorXd(z.object);
    };
  };
  problem.end = end([&](auto& z, double h) { return by.step(z, h); });
  EXPECT_TRUE(laws::order_laws(by.traits(), problem).holds()) << laws::measured_order(problem);
  MethodTraits four = by.traits();
  four.order = 4;
  problem.end = end([&](auto& z, double h) { return composed_step(by, z, h, compositions::suzuki); });
  EXPECT_TRUE(laws::order_laws(four, problem).holds()) << laws::measured_order(problem);
}

TEST(PrimaryConstraint, AStepBackReturns) {
  const PrimaryConstraintStep<Trapezoidal<Prey>> by(Trapezoidal<Prey>{});
  const auto start = by.on(Vector<double, 2>(1.5, 0.8));
  auto z = start;
  for (int k = 0; k < 10; ++k) ASSERT_EQ(by.step(z, 0.2), SolveStatus::converged);
  EXPECT_GT((z.object - start.object).norm(), 0.1);
  for (int k = 0; k < 10; ++k) ASSERT_EQ(by.step(z, -0.2), SolveStatus::converged);
  EXPECT_LT((z.object - start.object).norm(), 1e-13);
}

/// x' does not occur with y', and theta is a gradient: nothing moves.
struct Gauge : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return q(1) * v(0) + q(0) * v(1) - q(0) * q(0);
  }
};
struct Regular : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return v.squaredNorm() * 0.5 + q(0) * v(1) - q(1) * v(0) - q.squaredNorm();
  }
};
TEST(PrimaryConstraint, WhatItDoesNotBearIsTyped) {
  const auto status = []<class L>(const L&, const Vector<double, 2>& q, double h) {
    const PrimaryConstraintStep<Midpoint<L>> by(Midpoint<L>{});
    auto z = by.on(q);
    const auto before = z;
    const SolveStatus found = by.step(z, h);
    EXPECT_EQ((z.object - before.object).norm(), 0);
    return found;
  };
  EXPECT_EQ(status(Gauge{}, {1, 0.5}, 0.1), SolveStatus::singular);
  EXPECT_EQ(status(Regular{}, {1, 0.5}, 0.1), SolveStatus::singular);
  const PrimaryConstraintStep<Midpoint<Prey>> by(Midpoint<Prey>{});
  auto beyond = by.on({-1.0, 0.5});
  EXPECT_EQ(by.step(beyond, 0.1), SolveStatus::not_finite);
}

}  // namespace
}  // namespace hamilton_pontryagin_primary_constraint_tests
