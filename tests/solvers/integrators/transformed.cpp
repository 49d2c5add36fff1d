// Splitting in transformed time: orders, exact orbits, close approaches.

#include "../../support/allocation_counter.hpp"

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

using namespace lagroid;

namespace integrators_transformed_tests {
namespace {

static_assert(AttractiveSystem<Kepler> && !AttractiveSystem<Pendulum>);

/// From the pericentre of an ellipse with great axis 2; period 2 pi.
State<Pair<2>> pericentre(double e) { return {{1 - e, 0}, {0, std::sqrt((1 + e) / (1 - e))}}; }

TransformedIntegrator<Kepler> make(const State<Pair<2>>& start, double h, const Composition& composition) {
  Kepler system;
  system.h = h;
  return {system, start, {start.object, start.object}, composition};
}

/// The eccentricity vector, along the great axis.
Vector<double, 2> eccentricity(const State<Pair<2>>& z) {
  const double turning = z.object(0) * z.momentum(1) - z.object(1) * z.momentum(0);
  return Vector<double, 2>(z.momentum(1), -z.momentum(0)) * turning - z.object.normalized();
}

TEST(Transformed, OrdersOnAKeplerOrbit) {
  const auto start = pericentre(0.3);
  const Kepler kepler;
  for (const auto& composition : compositions::all) {
    // Ends lie where the steps end: compared with the motion there.
    const auto error = [&](int steps) {
      const double h = 5.0 / steps;
      auto run = make(start, h, composition);
      EXPECT_EQ(run.traits().order, composition.order);
      for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
      const auto exact = kepler.reference(start, run.point().time);
      return (run.point().state.object - exact.object).norm() + (run.point().state.momentum - exact.momentum).norm();
    };
    EXPECT_NEAR(laws::measured_order(error, composition.order == 2 ? 40 : 12, 2e-11), composition.order, 0.25)
        << composition.name;
  }
}

TEST(Transformed, KeepsTheOrbitExactly) {
  const auto start = pericentre(0.6);
  auto run = make(start, 0.05, compositions::single);
  for (int k = 0; k < 100'000; ++k) ASSERT_TRUE(run.advance().converged());
  const Kepler kepler;
  EXPECT_LT(std::abs(kepler.energy(run.point().state) + 0.5), 1e-13);
  EXPECT_LT((eccentricity(run.point().state) - eccentricity(start)).norm(), 1e-11);
  // Equal steps turn the axis.
  Kepler equal;
  equal.h = 0.05;
  const auto turning = make_integrator(equal, start, {start.object, start.object}, {.fixed = StepKind::splitting});
  for (int k = 0; k < 2'000; ++k) ASSERT_TRUE(turning->advance().converged());
  EXPECT_GT((eccentricity(turning->point().state) - eccentricity(start)).norm(), 1e-2);
}

TEST(Transformed, ReturnsByStepsBack) {
  const auto start = pericentre(0.6);
  for (const auto& composition : compositions::all) {
    auto there = make(start, 0.05, composition);
    for (int k = 0; k < 50; ++k) ASSERT_TRUE(there.advance().converged());
    State<Pair<2>> turned = there.point().state;
    turned.momentum = -turned.momentum;
    // The same length of s, which is h times the depth where an integrator begins.
    auto back = make(turned, 0.05 * turned.object.norm() / start.object.norm(), composition);
    for (int k = 0; k < 50; ++k) ASSERT_TRUE(back.advance().converged());
    EXPECT_LT((back.point().state.object - start.object).norm(), 1e-11) << composition.name;
    EXPECT_LT((back.point().state.momentum + start.momentum).norm(), 1e-11) << composition.name;
  }
}

TEST(Transformed, PassesCloseByInFewSteps) {
  const double e = 0.99;
  const State<Pair<2>> start{{-1 - e, 0}, {0, -std::sqrt((1 - e) / (1 + e))}};
  const Kepler kepler;
  auto run = make(start, 0.2, compositions::kahan_li_8);
  long steps = 0;
  while (run.point().time < 20 * std::numbers::pi) {
    ASSERT_TRUE(run.advance().converged());
    ++steps;
  }
  EXPECT_LT(steps, 1000);
  const auto exact = kepler.reference(start, run.point().time);
  EXPECT_LT((run.point().state.object - exact.object).norm(), 1e-8);
  EXPECT_LT(std::abs(kepler.energy(run.point().state) - kepler.energy(start)), 1e-12);
}

TEST(Transformed, EndsWhereTheEnergyIsNotNegative) {
  const auto start = pericentre(0.3);
  Kepler repelled;
  repelled.strength = -1;
  repelled.h = 0.1;
  TransformedIntegrator<Kepler> run(repelled, start, {start.object, start.object});
  EXPECT_EQ(run.advance().status, SolveStatus::left_domain);
  EXPECT_EQ(run.point().index, 0);
  EXPECT_EQ(run.point().state.object, start.object);
  EXPECT_THROW(make(start, 0.1, splittings::s10), std::invalid_argument);
  EXPECT_THROW(make_integrator(Pendulum{}, {}, {}, {.mode = TimeMode::transformed}), std::invalid_argument);
}

TEST(Transformed, AllocatesNothing) {
  auto run = make(pericentre(0.6), 0.05, compositions::kahan_li_8);
  ASSERT_TRUE(run.advance().converged());
  const long before = allocation_count();
  if (before < 0) GTEST_SKIP() << "allocations cannot be counted here";
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(run.advance().converged());
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace integrators_transformed_tests
