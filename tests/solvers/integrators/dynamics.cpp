// Lagrangian submanifolds and Poisson maps, and what is neither. (Those of the library's systems: certificates.cpp.)
#include <lagroid/solvers/testing/dynamics_laws.hpp>
#include <lagroid/systems/control/attitude_control.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include "../../support/broken.hpp"
#include "../../support/hasty_solver.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace integrators_dynamics_tests {
namespace {

/// q1 alone enters: the system is not regular.
struct HalfBlind : System<HalfBlind, Pair<2>> {
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    return g.source(0) * g.target(0) + g.source(1) * g.source(1) * g.target(0);
  }
};
TEST(LegendreRanks, AreEqualAlsoWhereTheyAreNotFull) {
  const HalfBlind system;
  const Step<HalfBlind> step{{Eigen::Vector2d(0.3, 0.7), Eigen::Vector2d(-1, 2)}, {}};
  const auto tangent = GeneratedSubmanifold<HalfBlind>(system).tangent(step);
  const auto ranks = legendre_ranks(tangent);
  EXPECT_EQ(ranks.minus, ranks.plus);
  EXPECT_EQ(ranks.minus, 3);
  EXPECT_LT(lagrangian_defect(tangent.canonical), 1e-14);
  EXPECT_LT(poisson_defect(tangent), 1e-13);
}

/// F+ with a thousandth of the momentum lost, as by friction; and covectors that no function generates.
template <class Sys> struct WithFriction : GeneratedSubmanifold<Sys> {
  using GeneratedSubmanifold<Sys>::GeneratedSubmanifold;
  SubmanifoldTangent tangent(const Step<Sys>& step) const {
    auto t = GeneratedSubmanifold<Sys>::tangent(step);
    t.plus.bottomRows(Sys::dimension) *= 0.999;
    return t;
  }
};
template <class Sys, class Draw> laws::LawReport laws_with_friction(const Sys& system, const Draw& draw) {
  return laws::dynamics_laws<Sys, Draw, WithFriction<Sys>>(system, draw);
}
struct NotLagrangian : GeneratedSubmanifold<Kepler> {
  using GeneratedSubmanifold::GeneratedSubmanifold;
  SubmanifoldTangent tangent(const Step<Kepler>& step) const {
    auto t = GeneratedSubmanifold::tangent(step);
    t.canonical.row(4) += 1e-3 * t.canonical.row(1);
    t.minus.row(0).swap(t.minus.row(1));
    t.plus.row(3) = t.plus.row(2);
    return t;
  }
};
State<Pair<2>> draw_orbit() { return {{1, 0.2 * laws::draw_uniform()}, {0.1, 1}}; }
State<Pair<3>> draw_swing() {
  const Vector<double, 3> q = (laws::draw_vector<3>(0.5) - Vector<double, 3>::UnitZ()).normalized();
  return {q, q.cross(Vector<double, 3>(0.3, 0.5, laws::draw_uniform()))};
}
AttitudeControl uneven_control() {
  AttitudeControl control;
  control.weights << 1, 1.7, 0.6;
  return control;
}
State<SO3> draw_turn() { return {{}, Vector<double, 3>(0.9, -0.4, 1.1) + laws::draw_vector<3>(0.3)}; }

TEST(BrokenDynamics, FailsTheLawsItBreaks) {
  const auto rubbed = laws_with_friction(Kepler{}, draw_orbit);
  EXPECT_TRUE(laws::seen_broken(rubbed.law("the step is Poisson"))) << rubbed;
  const auto twisted = laws::dynamics_laws<Kepler, decltype(draw_orbit), NotLagrangian>(Kepler{}, draw_orbit);
  EXPECT_TRUE(laws::seen_broken(twisted.law("Sigma_L is Lagrangian"))) << twisted;
  EXPECT_TRUE(laws::seen_broken(twisted.law("Legendre transforms have equal rank"))) << twisted;
}

TEST(BrokenDynamics, FrictionUnderConstraintsIsNotPoisson) {
  const auto swing = laws_with_friction(SphericalPendulum{}, draw_swing);
  const auto turn = laws_with_friction(uneven_control(), draw_turn);
  for (const auto& report : {swing, turn}) {
    EXPECT_TRUE(laws::seen_broken(report.law("the step is Poisson"))) << report;
    EXPECT_TRUE(report.law("Sigma_L is Lagrangian").holds()) << report;
    EXPECT_TRUE(report.law("the step reverses").holds()) << report;
  }
}

/// Steps that L generates are Poisson whatever a solver makes of them.
laws::LawReport laws_of_long_steps(const laws::MakeStepSolver<Kepler>& make) {
  Kepler system;
  system.quadrature = Quadrature::midpoint;  // by the trapezoid one iteration solves them
  system.h = 0.5;
  auto report = laws::dynamics_laws(system, draw_orbit, 1e-10, make);
  EXPECT_TRUE(report.law("the step is Poisson").holds()) << report;
  return report;
}
TEST(BrokenComputedStep, OfASolverThatStopsEarly) {
  const auto report = laws_of_long_steps([] { return std::make_unique<Hasty<Kepler>>(); });
  EXPECT_TRUE(laws::seen_broken(report.law("the computed step is Poisson"))) << report;
}

/// Loses a thousandth of the change of momentum.
class Lossy final : public StepSolver<Kepler> {
 public:
  StepReport solve(const Kepler& system, const State<Pair<2>>& state, StepSolution<Kepler>& solution) override {
    const StepReport report = newton_.solve(system, state, solution);
    solution.momentum_change *= 0.999;
    return report;
  }

 private:
  NewtonStep<Kepler> newton_;
};
TEST(BrokenComputedStep, OfASolverThatLosesMomentum) {
  const auto report = laws_of_long_steps([] { return std::make_unique<Lossy>(); });
  EXPECT_TRUE(laws::seen_broken(report.law("the computed step is Poisson"))) << report;
}

/// By Ceres, under object constraints and arrow constraints too.
TEST(ComputedStep, IsPoisson) {
  const auto expect = [](const auto& system, const auto& draw) {
    const auto report =
        laws::dynamics_laws(system, draw, 1e-10, [&] { return make_step_solver(system, StepMethod::ceres); });
    EXPECT_TRUE(report.law("the computed step is Poisson").holds()) << report;
  };
  expect(Kepler{}, draw_orbit);
  expect(SphericalPendulum{}, draw_swing);
  expect(uneven_control(), draw_turn);
}

/// A spring whose derivatives by hand lose a thousandth of F+.
struct Leaking : System<Leaking, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 / h) - (g.source(0) * g.source(0) + g.target(0) * g.target(0)) * (0.25 * h);
  }
  TwoSided<1, 0> two_sided(const PairArrow<double, 1>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(*this, g, lambda);
    d.target_gradient *= 0.999;
    return d;
  }
};
TEST(BrokenDynamics, DerivativesThatAreNotTheLagrangiansAreFoundOut) {
  const auto report = laws::dynamics_laws(Leaking{}, [] {
    return State<Pair<1>>{Vector<double, 1>(0.5), Vector<double, 1>(1.0)};
  });
  EXPECT_TRUE(laws::seen_broken(report.law("Legendre transforms are source and target"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("products of steps compose"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("the step reverses"))) << report;
}

/// An oscillator by Euler's two methods.
TEST(PoissonDefect, TellsSymplecticMapsFromOthers) {
  const Pair<1> line;
  const CotangentGroupoid<Pair<1>>::Object<double> z{Vector<double, 1>(0.3), Vector<double, 1>(-0.8)};
  const double h = 0.1;
  const auto force = [](const auto& q) { return (q.array() * q.array() * q.array() * -1.0).matrix().eval(); };
  const auto explicit_euler = [&](auto p) {
    const auto q = p.object;
    p.object += h * p.momentum;
    p.momentum += h * force(q);
    return p;
  };
  const auto symplectic_euler = [&](auto p) {
    p.momentum += h * force(p.object);
    p.object += h * p.momentum;
    return p;
  };
  EXPECT_LT(poisson_defect(line, z, symplectic_euler), 1e-15);
  EXPECT_GT(poisson_defect(line, z, explicit_euler), 1e-4);
}

/// Lie-Poisson: rotations of the body momentum are Poisson maps of so(3)*, other linear maps are not.
TEST(PoissonDefect, OnTheDualOfALieAlgebra) {
  const SO3 rotations;
  const CotangentGroupoid<SO3>::Object<double> z{{}, Eigen::Vector3d(1, -2, 0.5)};
  const Matrix<double, 3, 3> r = SO3::exp(Vector<double, 3>(0.3, 0.2, -1));
  const auto by = [](const Matrix<double, 3, 3>& a) {
    return [a](auto p) {
      const Matrix<typename decltype(p.momentum)::Scalar, 3, 3> aj = a.cast<typename decltype(p.momentum)::Scalar>();
      p.momentum = (aj * p.momentum).eval();
      return p;
    };
  };
  EXPECT_LT(poisson_defect(rotations, z, by(r)), 1e-14);
  EXPECT_GT(poisson_defect(rotations, z, by(Matrix<double, 3, 3>(1.01 * r))), 1e-3);
}

}  // namespace
}  // namespace integrators_dynamics_tests
