// What splittings keep: they are reversible, Poisson, and keep momenta and energies.
#include "problems.hpp"

#include "../../../support/allocation_counter.hpp"

#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/splitting_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::splitting_tests::properties_tests {
namespace {

// ---- what steps keep

template <class Sys> double distance_after_return(const Problem<Sys>& problem, const Composition& composition) {
  Sys system = problem.system;
  system.h = 0.05;
  auto there = make(system, problem.start, composition);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(there.advance().converged());
  system.h = -system.h;
  SplittingIntegrator<Sys> back(system, there.point().state, there.point().configuration, composition);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(back.advance().converged());
  const auto unit = system.groupoid.unit(problem.start.object);
  return (system.groupoid.coordinates_of_arrow(back.point().configuration) - system.groupoid.coordinates_of_arrow(unit))
             .norm() +
         (back.point().state.momentum - problem.start.momentum).norm();
}

TEST(Splittings, ReturnByStepsBack) {
  for (const auto& composition : splittings::all) {
    EXPECT_LT(distance_after_return(orbit(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(lagrange_top(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(bob(), composition), 1e-12) << composition.name;
  }
  for (const auto& composition : compositions::all) {
    EXPECT_LT(distance_after_return(swing(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(orbit(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(body(), composition), 1e-12) << composition.name;
    EXPECT_LT(distance_after_return(top(), composition), 1e-12) << composition.name;
  }
  EXPECT_GT(distance_after_return(top(), lopsided), 1e-6);
}

template <class Sys> double defect_of(const Problem<Sys>& problem, const Composition& composition) {
  return poisson_defect(problem.system.groupoid, {problem.start.object, problem.start.momentum},
                        laws::splitting_map(problem.system, composition, 0.3));
}

TEST(Splittings, ArePoisson) {
  for (const auto& composition : splittings::all) {
    EXPECT_LT(defect_of(orbit(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(lagrange_top(), composition), 1e-14) << composition.name;
  }
  for (const auto& composition : compositions::all) {
    EXPECT_LT(defect_of(swing(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(orbit(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(body(), composition), 1e-14) << composition.name;
    EXPECT_LT(defect_of(top(), composition), 1e-14) << composition.name;
  }
  EXPECT_GT(poisson_defect(Pair<2>{}, {orbit().start.object, orbit().start.momentum},
                           laws::splitting_map(Rubbed{}, compositions::single, 0.3)),
            1e-5);
}

/// The largest deviation of every quantity over the run, by name, relative to its first norm.
template <class Sys>
double drift_of(const std::string& name, const Sys& system, const State<typename Sys::GroupoidType>& start,
                const Composition& composition, long steps) {
  const auto quantities = system.quantities();
  const auto quantity =
      std::find_if(quantities.begin(), quantities.end(), [&](const auto& q) { return q.name == name; });
  if (quantity == quantities.end()) throw std::invalid_argument(name);
  const auto value = [&](const TrajectoryPoint<Sys>& point) {
    Eigen::VectorXd out(quantity->components.size());
    quantity->evaluate(point, out.data());
    return out;
  };
  auto integrator = make(system, start, composition);
  const Eigen::VectorXd first = value(integrator.point());
  double drift = 0;
  for (long k = 0; k < steps; ++k) {
    if (!integrator.advance().converged()) return std::numeric_limits<double>::infinity();
    drift = std::max(drift, (value(integrator.point()) - first).norm() / first.norm());
  }
  return drift;
}

TEST(Splittings, KeepMomenta) {
  // No more than a random walk of round-off.
  constexpr long steps = 100'000;
  const double walk = 20 * std::numeric_limits<double>::epsilon() * std::sqrt(double(steps));
  for (const auto& composition : {compositions::single, compositions::kahan_li_6}) {
    EXPECT_LT(drift_of("angular momentum", Kepler{}, orbit().start, composition, steps), walk);
    EXPECT_LT(drift_of("spatial momentum A M", RigidBody{}, body().start, composition, steps), walk);
    EXPECT_LT(drift_of("vertical momentum M.v", asymmetric_top(), leaning, composition, steps), walk);
    EXPECT_LT(drift_of("axial momentum M3", HeavyTop{}, leaning, composition, steps), walk);
  }
}

TEST(Splittings, KeepNoMomentumOfASymmetryThatAPartBreaks) {
  // The symmetric top, kicked aside.
  HeavyTop top;
  top.weight << 1e-3, 0, 1;
  auto integrator = make(top, leaning, compositions::single);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_GT(std::abs(integrator.point().state.momentum(2) - leaning.momentum(2)), 1e-5);
}

TEST(Splittings, KeepTheEnergyInABandThatShrinksWithTheStep) {
  for (const auto& composition : {compositions::single, compositions::suzuki}) {
    std::vector<double> band;
    for (const double h : {0.1, 0.05}) {
      HeavyTop top = asymmetric_top();
      top.h = h;
      band.push_back(drift_of("energy", top, leaning, composition, long(1000 / h)));
    }
    EXPECT_NEAR(std::log2(band[0] / band[1]), composition.order, 0.3) << composition.name;
  }
}

TEST(Splittings, OfASymmetricBodyAreExact) {
  RigidBody system;
  system.inertia << 1, 2, 1;
  system.h = 0.5;
  const State<SO3> start = body().start;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = system.reference(start, attitude, 10);
  auto integrator = make(system, start, compositions::single);
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(integrator.advance().converged());
  EXPECT_LT((integrator.point().state.momentum - exact.momentum).norm(), 1e-12);
  EXPECT_LT((integrator.point().configuration - attitude).norm(), 1e-12);
}

// ---- against the implicit steps, and at their limits

template <class Sys> double distance_from_the_trapezoid(Sys system, const State<typename Sys::GroupoidType>& start) {
  system.h = 0.05;
  system.quadrature = Quadrature::trapezoid;
  auto explicitly = make(system, start, compositions::single);
  FixedStepIntegrator<Sys> implicitly(system, start, system.groupoid.unit(start.object),
                                      std::make_unique<NewtonStep<Sys>>());
  double distance = 0;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_TRUE(explicitly.advance().converged());
    EXPECT_TRUE(implicitly.advance().converged());
    const auto& a = explicitly.point().state;
    const auto& b = implicitly.point().state;
    distance = std::max(distance, (a.object - b.object).norm() + (a.momentum - b.momentum).norm());
  }
  return distance;
}

TEST(StormerVerlet, IsTheStepOfTheTrapezoid) {
  EXPECT_LT(distance_from_the_trapezoid(Pendulum{}, swing().start), 1e-12);
  EXPECT_LT(distance_from_the_trapezoid(Kepler{}, orbit().start), 1e-11);
}

TEST(Splittings, AllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const auto count = [](const auto& problem) {
    auto integrator = make(problem.system, problem.start, compositions::kahan_li_8);
    const long before = allocation_count();
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(integrator.advance().converged());
    return allocation_count() - before;
  };
  EXPECT_EQ(count(swing()), 0);
  EXPECT_EQ(count(orbit()), 0);
  EXPECT_EQ(count(body()), 0);
  EXPECT_EQ(count(top()), 0);
}

TEST(Splittings, DoNotAdvanceIntoASingularity) {
  const State<Pair<2>> centre{{0, 0}, {0, 1}};
  auto integrator = make(Kepler{}, centre, compositions::single);
  EXPECT_EQ(integrator.advance().status, SolveStatus::not_finite);
  EXPECT_EQ(integrator.point().index, 0);
  EXPECT_EQ(integrator.point().state.momentum, centre.momentum);
}

}  // namespace
}  // namespace lagroid::splitting_tests::properties_tests
