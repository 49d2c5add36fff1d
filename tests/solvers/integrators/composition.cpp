// Compositions of implicit steps: declared orders, momenta, symmetry, constraints, first-order steps and their
// adjoints.
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include "../../support/broken.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace lagroid;

namespace integrators_composition_tests {
namespace {

template <class Sys>
std::unique_ptr<Integrator<Sys>> make(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                      const Composition& composition) {
  IntegratorOptions options;
  options.composition = composition;
  return make_integrator(system, start, system.groupoid.unit(start.object), options);
}

template <class Sys> Eigen::VectorXd coordinates(const Sys& system, const State<typename Sys::GroupoidType>& s) {
  const auto q = system.groupoid.coordinates_of_object(s.object);
  Eigen::VectorXd out(q.size() + s.momentum.size());
  out << q, tangent_momentum(system, s);
  return out;
}

/// Whether all compositions reach the end with the order they declare.
template <class Sys>
void expect_declared_orders(Sys system, const State<typename Sys::GroupoidType>& start, double horizon,
                            const State<typename Sys::GroupoidType>& exact, int coarsest, double plateau = 1e-11) {
  for (const auto& composition : compositions::all) {
    laws::OrderProblem problem;
    problem.exact = coordinates(system, exact);
    problem.coarsest = coarsest;
    problem.plateau = plateau;
    problem.end = [&](int steps) {
      system.h = horizon / steps;
      const auto run = make(system, start, composition);
      // Steps too long to be solved err without bound.
      for (int k = 0; k < steps; ++k)
        if (!run->advance().converged())
          return Eigen::VectorXd(
              Eigen::VectorXd::Constant(problem.exact.size(), std::numeric_limits<double>::infinity()));
      return coordinates(system, run->point().state);
    };
    const auto report = laws::order_laws(make(system, start, composition)->traits(), problem);
    EXPECT_TRUE(report.holds()) << report << " saw " << laws::measured_order(problem);
  }
}

TEST(Composition, OrdersOnThePendulum) {
  Pendulum system;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  expect_declared_orders(system, start, 20.0, system.reference(start, 20.0), 40);
}
TEST(Composition, OrdersOnAKeplerOrbit) {
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  expect_declared_orders(system, start, 6.0, system.reference(start, 6.0), 30, 5e-11);
}
TEST(Composition, OrdersOnTheRigidBody) {
  RigidBody system;
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  expect_declared_orders(system, start, 60.0, system.reference(start, attitude, 60.0), 60);
}
TEST(Composition, OrdersOnTheHeavyTop) {
  HeavyTop system;
  system.inertia << 1, 2, 3;
  system.weight << 0.1, 0.2, 1;
  const State<HeavyTop::GroupoidType> start{Vector<double, 3>(0.36, 0.48, 0.8), {0.5, 1.1, 0.8}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  expect_declared_orders(system, start, 10.0, system.reference(start, attitude, 10.0), 15);
}
TEST(Composition, OrdersOnThePlateBall) {
  PlateBall system;
  system.rotation = RotationForm::exponential;
  system.plate_rate = 0.7;
  system.spin = 0.4;
  State<PlateBall::GroupoidType> start;
  std::get<0>(start.object) << 0.3, -0.2;
  start.momentum << 0.9, 0.2, 0.6, -0.3, 0.5;
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  expect_declared_orders(system, start, 6.0, system.reference(start, attitude, 6.0), 12);
}
// Time enters the Lagrangian: stages begin at their own times, back and forth.
TEST(Composition, OrdersOnADrivenPendulum) {
  DrivenPendulum system;
  system.torque = 0.4;
  system.amplitude = 0.1;
  system.frequency = 2.3;
  system.time = 0.7;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  expect_declared_orders(system, start, 5.0, system.reference(start, 5.0), 12);
}
// Object constraints: the projected map is composed.
TEST(Composition, OrdersOnTheSphericalPendulum) {
  SphericalPendulum system;
  const State<Pair<3>> start{{0.6, 0, -0.8}, {0.4, 0.5, 0.3}};
  expect_declared_orders(system, start, 10.0, system.reference(start, 10.0), 15);
}

/// U at the source of the arrow: symplectic Euler, of order one.
struct Leaning : MechanicalSystem<Leaning, 1> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const {
    using std::cos;
    return -cos(q(0));
  }
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 / step) - potential(g.source) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, h); }
};

double observed(const Composition& composition, bool with_adjoint) {
  Leaning system;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  laws::OrderProblem problem;
  problem.exact = coordinates(system, system.reference(start, 5.0));
  problem.coarsest = composition.order > 4 ? 8 : 40;
  problem.end = [&](int steps) {
    system.h = 5.0 / steps;
    const auto unit = system.groupoid.unit(start.object);
    if (with_adjoint) {
      using Either = WithAdjoint<Leaning>;
      CompositionIntegrator<Either> run(symmetrised(system, composition), start, unit, composition,
                                        [] { return std::make_unique<NewtonStep<Either>>(); });
      for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
      return coordinates(system, run.point().state);
    }
    const auto run = make(system, start, composition);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run->advance().converged());
    return coordinates(system, run->point().state);
  };
  return laws::measured_order(problem);
}
TEST(Composition, FirstOrderStepsAreSymmetrisedByTheirAdjoints) {
  EXPECT_NEAR(observed(compositions::single, true), 2, 0.1);
  EXPECT_NEAR(observed(compositions::suzuki, true), 4, 0.1);
  EXPECT_NEAR(observed(compositions::kahan_li_6, true), 6, 0.1);
  EXPECT_NEAR(observed(compositions::single, false), 1, 0.1);
  // What the coefficients cannot do for a step that is not symmetric.
  EXPECT_LT(observed(compositions::suzuki, false), 2.5);
}

TEST(BrokenMethod, DeclaresAnOrderItDoesNotHave) {
  Pendulum system;
  const State<Pair<1>> start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
  constexpr std::array coefficients{0.4, 0.2, 0.4};
  const Composition made_up{"made up", 4, coefficients, ""};
  laws::OrderProblem problem;
  problem.exact = coordinates(system, system.reference(start, 5.0));
  problem.coarsest = 100;
  problem.plateau = 1e-7;
  problem.end = [&](int steps) {
    system.h = 5.0 / steps;
    const auto run = make(system, start, made_up);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run->advance().converged());
    return coordinates(system, run->point().state);
  };
  const auto report = laws::order_laws(make(system, start, made_up)->traits(), problem);
  EXPECT_TRUE(laws::seen_broken(report.law("the error falls as declared")));
  EXPECT_NEAR(laws::measured_order(problem), 2, 0.1);
}

// Momenta to round-off, energy better by orders, and back again.
TEST(Composition, KeepsMomentaAndReturns) {
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  system.h = 0.1;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  const auto out = make(system, start, compositions::kahan_li_8);
  const double momentum = 0.7 * start.momentum(1);
  double energy_error = 0;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(out->advance().converged());
    const auto& s = out->point().state;
    EXPECT_NEAR(s.object(0) * s.momentum(1) - s.object(1) * s.momentum(0), momentum, 1e-13);
    energy_error = std::max(energy_error, std::abs(system.energy(s) - system.energy(start)));
  }
  EXPECT_LT(energy_error, 1e-6);
  auto turned = out->point().state;
  turned.momentum *= -1;
  const auto back = make(system, turned, compositions::kahan_li_8);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(back->advance().converged());
  EXPECT_LT((back->point().state.object - start.object).norm() + (back->point().state.momentum + start.momentum).norm(),
            1e-9);
  EXPECT_NEAR(back->point().time, 100, 1e-12);
}

/// Solves a given number of steps, then no more.
class Tired final : public StepSolver<Kepler> {
 public:
  explicit Tired(long* left) : left_(left) {}
  StepReport solve(const Kepler& system, const State<Pair<2>>& state, StepSolution<Kepler>& solution) override {
    if (--*left_ < 0) return {SolveStatus::stagnated};
    return newton_.solve(system, state, solution);
  }

 private:
  long* left_;
  NewtonStep<Kepler> newton_;
};
TEST(Composition, AFailedStageLeavesTheStepUndone) {
  Kepler system;
  system.quadrature = Quadrature::midpoint;
  system.h = 0.1;
  const State<Pair<2>> start{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
  long left = 1000000;
  CompositionIntegrator<Kepler> run(system, start, {start.object, start.object}, compositions::suzuki,
                                    [&] { return std::make_unique<Tired>(&left); });
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(run.advance().converged());
  const auto before = run.point();
  left = 3;
  EXPECT_EQ(run.advance().status, SolveStatus::stagnated);
  EXPECT_EQ(run.point().index, before.index);
  EXPECT_EQ(run.point().state.object, before.state.object);
  EXPECT_EQ(run.point().state.momentum, before.state.momentum);
  left = 1000000;
  EXPECT_TRUE(run.advance().converged());
}

}  // namespace
}  // namespace integrators_composition_tests
