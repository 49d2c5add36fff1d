// Discrete Lagrangians with inner nodes: orders by the number of nodes, momenta, the nodes' momentum.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/galerkin.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace integrators_galerkin_tests {
namespace {

template <class Sys> FixedStepIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return {system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>()};
}

template <class Sys, class Base>
void expect_order(const Base& base, const State<typename Base::GroupoidType>& start, double horizon,
                  const State<typename Base::GroupoidType>& exact, int coarsest) {
  laws::OrderProblem problem;
  const auto list = [&](const State<typename Base::GroupoidType>& s) {
    const auto q = base.groupoid.coordinates_of_object(s.object);
    Eigen::VectorXd out(q.size() + s.momentum.size());
    out << q, s.momentum;
    return out;
  };
  problem.exact = list(exact);
  problem.coarsest = coarsest;
  problem.end = [&](int steps) {
    Sys system(base);
    system.h = horizon / steps;
    auto run = make(system, Sys::extended(start));
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged()) << k;
    return list(Sys::reduced(run.point().state));
  };
  const auto report = laws::order_laws(Sys::traits(), problem);
  EXPECT_TRUE(report.holds()) << report << " saw " << laws::measured_order(problem);
}

TEST(Galerkin, OrdersOnThePendulum) {
  const Pendulum base;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  const auto exact = base.reference(start, 20.0);
  expect_order<GalerkinMechanics<Pendulum, 2>>(base, start, 20.0, exact, 40);
  expect_order<GalerkinMechanics<Pendulum, 3>>(base, start, 20.0, exact, 30);
  expect_order<GalerkinMechanics<Pendulum, 4>>(base, start, 40.0, base.reference(start, 40.0), 80);
}
TEST(Galerkin, OrdersOnAKeplerOrbit) {
  const Kepler base;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  const auto exact = base.reference(start, 3.0);
  expect_order<GalerkinMechanics<Kepler, 2>>(base, start, 3.0, exact, 20);
  expect_order<GalerkinMechanics<Kepler, 3>>(base, start, 3.0, exact, 10);
}
TEST(Galerkin, OrdersOnTheRigidBody) {
  const RigidBody base;
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto exact = base.reference(start, attitude, 4.0);
  expect_order<GalerkinGroup<RigidBody, 2>>(base, start, 4.0, exact, 10);
  expect_order<GalerkinGroup<RigidBody, 3>>(base, start, 4.0, exact, 6);
}

// The momentum of the inner nodes stays exactly zero: what makes them stationary. And symmetries are kept.
TEST(Galerkin, NodesStayStationaryAndMomentaAreKept) {
  GalerkinMechanics<Kepler, 3> system{Kepler{}};
  system.h = 0.1;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  auto run = make(system, system.extended(start));
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged());
    const auto& s = run.point().state;
    ASSERT_EQ(s.momentum.tail<4>().norm(), 0);
    const auto& q = std::get<0>(s.object);
    EXPECT_NEAR(q(0) * s.momentum(1) - q(1) * s.momentum(0), 0.7 * start.momentum(1), 1e-13);
  }
}
TEST(Galerkin, SpatialMomentumOfTheBodyIsKept) {
  GalerkinGroup<RigidBody, 2> system{RigidBody{}};
  system.h = 0.2;
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  auto run = make(system, system.extended(start));
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged());
    const auto& p = run.point();
    EXPECT_LT((std::get<0>(p.configuration) * p.state.momentum.head<3>() - start.momentum).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace integrators_galerkin_tests
