// Orders of compositions and of splittings.
#include "problems.hpp"

#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace lagroid::splitting_tests::orders_tests {
namespace {

double power_sum(const Composition& composition, int k) {
  double sum = 0;
  for (const double gamma : composition.coefficients) sum += std::pow(gamma, k);
  return sum;
}

double largest_defect_of_the_conditions(const Composition& composition) {
  double defect = std::abs(power_sum(composition, 1) - 1);
  for (int k = 3; k < composition.order; k += 2) defect = std::max(defect, std::abs(power_sum(composition, k)));
  return defect;
}

bool is_symmetric(const Composition& composition) {
  const auto& gamma = composition.coefficients;
  return std::equal(gamma.begin(), gamma.end(), gamma.rbegin());
}

TEST(Compositions, MeetTheConditionsOfTheirOrder) {
  for (const auto& composition : compositions::all) {
    EXPECT_TRUE(is_symmetric(composition)) << composition.name;
    EXPECT_LT(largest_defect_of_the_conditions(composition), 1e-14) << composition.name;
    // No condition of the next order holds by chance.
    EXPECT_GT(std::abs(power_sum(composition, composition.order + 1)), 1e-15) << composition.name;
  }
}

TEST(Compositions, OfMistypedCoefficientsDoNot) {
  for (const auto& composition : compositions::all) {
    if (composition.stages() == 1) continue;
    std::vector<double> wrong(composition.coefficients.begin(), composition.coefficients.end());
    std::swap(wrong[0], wrong[wrong.size() / 2]);
    EXPECT_FALSE(is_symmetric({"mistyped", composition.order, wrong, ""})) << composition.name;
    wrong.assign(composition.coefficients.begin(), composition.coefficients.end());
    wrong.front() += 1e-8;
    wrong.back() += 1e-8;
    EXPECT_GT(largest_defect_of_the_conditions({"mistyped", composition.order, wrong, ""}), 1e-9) << composition.name;
  }
}

/// The error at the end of the run, in steps of horizon / steps.
template <class Sys> double error_of(const Problem<Sys>& problem, const Composition& composition, int steps) {
  Sys system = problem.system;
  system.h = problem.horizon / steps;
  auto integrator = make(system, problem.start, composition);
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(integrator.advance().converged());
  return problem.error(integrator.point());
}

template <class Sys> double order_of(const Problem<Sys>& problem, const Composition& composition) {
  return laws::measured_order([&](int steps) { return error_of(problem, composition, steps); }, problem.steps);
}

/// Compositions of steps, and those of two flows that are for the system.
template <class Sys> std::vector<Composition> all_for(const Sys& system) {
  std::vector<Composition> all(compositions::all.begin(), compositions::all.end());
  for (const auto& of_two_flows : splittings::all)
    if (splits_by(system, of_two_flows)) all.push_back(of_two_flows);
  return all;
}

template <class Sys> void expect_declared_orders(const Problem<Sys>& problem) {
  for (const auto& composition : compositions::all) {
    const auto declared = make(problem.system, problem.start, composition).traits();
    EXPECT_EQ(declared.order, composition.order);
    EXPECT_NEAR(order_of(problem, composition), declared.order, 0.1) << declared.name;
  }
}

TEST(Orders, OfThePendulum) { expect_declared_orders(swing()); }

TEST(Orders, OfKeplersProblem) { expect_declared_orders(orbit()); }

TEST(Orders, OfTheRigidBodyWithItsAttitude) { expect_declared_orders(body()); }

TEST(Orders, OfTheHeavyTopWithItsAttitude) { expect_declared_orders(top()); }

TEST(Orders, OfALagrangeTopWithItsAttitude) { expect_declared_orders(lagrange_top()); }

TEST(Orders, OfTheSphericalPendulum) { expect_declared_orders(bob()); }

/// Their error constants are small: orders show with few steps, and less clearly. After a whole period of an ellipse
/// that of order 4 looks higher, so that the orbit ends elsewhere.
template <class Sys> void expect_declared_orders_of_two_flows(Problem<Sys> problem) {
  problem.steps = 6;
  int asked = 0;
  for (const auto& of_two_flows : splittings::all) {
    if (!splits_by(problem.system, of_two_flows)) continue;
    ++asked;
    EXPECT_NEAR(order_of(problem, of_two_flows), of_two_flows.order, 0.35) << of_two_flows.name;
  }
  EXPECT_GE(asked, 2);
}

TEST(Orders, OfTwoFlows) {
  Problem<Kepler> arc = orbit();
  arc.horizon = 5;
  const auto exact = arc.system.reference(arc.start, arc.horizon);
  arc.error = [exact](const auto& end) {
    return (end.state.object - exact.object).norm() + (end.state.momentum - exact.momentum).norm();
  };
  expect_declared_orders_of_two_flows(arc);
  expect_declared_orders_of_two_flows(swing());
  expect_declared_orders_of_two_flows(bob());
  expect_declared_orders_of_two_flows(body());
  expect_declared_orders_of_two_flows(lagrange_top());
}

TEST(Orders, AreHadOnlyWhereTheSplittingIsForTheSystem) {
  EXPECT_EQ(all_for(Kepler{}).size(), 11u);
  EXPECT_EQ(all_for(SphericalPendulum{}).size(), 11u);
  EXPECT_EQ(all_for(RigidBody{}).size(), 8u) << "its first flow depends on the momentum";
  EXPECT_EQ(all_for(lagrange_top().system).size(), 11u);
  EXPECT_EQ(all_for(asymmetric_top()).size(), 6u) << "three flows";
  EXPECT_THROW(make(RigidBody{}, body().start, splittings::srkn11), std::invalid_argument);
  EXPECT_THROW(make(asymmetric_top(), leaning, splittings::s6), std::invalid_argument);
  // And rightly: taken for one of two flows, three do not have the order.
  struct Careless : HeavyTop {
    bool two_flows() const { return true; }
  };
  Careless careless;
  careless.inertia = asymmetric_top().inertia;
  careless.weight = asymmetric_top().weight;
  Problem<Careless> problem{careless, leaning, 5, 20, {}};
  const auto exact = top();
  problem.error = [&](const auto& end) {
    TrajectoryPoint<HeavyTop> as_top;
    as_top.state = end.state;
    as_top.configuration = end.configuration;
    return exact.error(as_top);
  };
  EXPECT_LT(order_of(problem, splittings::s10), 4.5);
}

TEST(Orders, OfACompositionThatIsNotSymmetricIsOdd) {
  EXPECT_LT(largest_defect_of_the_conditions(lopsided), 1e-14);
  EXPECT_NEAR(order_of(swing(), lopsided), 3, 0.1);
  EXPECT_NEAR(order_of(top(), lopsided), 3, 0.1);
}

}  // namespace
}  // namespace lagroid::splitting_tests::orders_tests
