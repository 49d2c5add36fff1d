// What a step does not survive is a status, and never a number: degenerate Lagrangians, inner nodes that are not found.
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "subjects.hpp"

#include <limits>

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

template <class Sys> SolveStatus failed_step(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  auto run = make(system, start);
  const StepReport report = run.advance();
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(run.point().time, 0) << "a step that failed was taken";
  EXPECT_EQ((run.point().state.momentum - start.momentum).norm(), 0);
  return report.status;
}

/// y' does not occur: degenerate.
struct HalfMoving : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return v(0) * v(0) * 0.5 - q(0) * q(0) * 0.5;
  }
};
TEST(AnyLagrangian, ADegenerateLagrangianIsATypedFailure) {
  const State<Pair<2>> start{{1, 0}, {0.2, 0.3}};
  EXPECT_EQ(failed_step(Midpoint<HalfMoving>{}, start), SolveStatus::singular);
  EXPECT_EQ(failed_step(Trapezoidal<HalfMoving>{}, start), SolveStatus::singular);
  EXPECT_EQ(failed_step(Galerkin<HalfMoving, 2>{}, start), SolveStatus::not_finite);
  EXPECT_EQ(failed_step(Galerkin<HalfMoving, 4>{}, start), SolveStatus::not_finite);
  using Beside = GalerkinOnNodes<HalfMoving, 2>;
  EXPECT_EQ(failed_step(Beside{}, Beside::extended(start)), SolveStatus::singular);
  EXPECT_TRUE(std::isnan(Midpoint<HalfMoving>{}.energy(start)));
}

/// v^2 / 2 - 50 exp(3 q): over a long step the action rises with the inner node, and has no stationary value.
struct Steep : ContinuousLagrangian<Pair<1>> {
  template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
    using std::exp;
    return v(0) * v(0) * 0.5 - exp(q(0) * 3.0) * 50.0;
  }
};
TEST(AnyLagrangian, InnerNodesThatAreNotFoundAreNotANumber) {
  const Galerkin<Steep, 2> system{Steep{}, 2.0};
  const PairArrow<double, 1> g{Vector<double, 1>(0.0), Vector<double, 1>(0.1)};
  EXPECT_TRUE(std::isnan(system.nodes(g)(0)));
  EXPECT_TRUE(std::isnan(system.lagrangian(g)));
  EXPECT_TRUE(std::isnan(gradients(system, g, {}).target_gradient(0)));
  EXPECT_EQ(failed_step(system, {Vector<double, 1>(0.0), Vector<double, 1>(0.1)}), SolveStatus::not_finite);
  // Of a short step they are found.
  const Galerkin<Steep, 2> shorter{Steep{}, 0.01};
  auto run = make(shorter, {Vector<double, 1>(0.0), Vector<double, 1>(0.1)});
  EXPECT_TRUE(run.advance().converged());
}

TEST(AnyLagrangian, WhatIsNotFiniteIsATypedFailure) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  failed_step(Galerkin<Swing, 3>{}, {Vector<double, 1>(1.0), Vector<double, 1>(1e308)});
  auto run = make(Galerkin<Swing, 3>{}, {Vector<double, 1>(nan), Vector<double, 1>(0.1)});
  EXPECT_FALSE(run.advance().converged());
}

/// A skate that may not slide pays for turning alone: the speed is free, so that l with psi is degenerate.
struct Skate : ContinuousLagrangian<SE2, 1> {
  template <class S> S l(const Vector<S, 0>&, const Vector<S, 3>& xi) const { return xi(0) * xi(0) * 0.5; }
  template <class S> Vector<S, 1> psi(const Vector<S, 0>&, const Vector<S, 3>& xi) const { return Vector<S, 1>(xi(2)); }
};
TEST(AnyLagrangian, AConstraintThatLeavesAVelocityUndeterminedIsSingular) {
  using Sys = GalerkinOnNodes<Skate, 2>;
  EXPECT_EQ(failed_step(Sys{}, Sys::extended({{}, {0.5, 0, 0.2}})), SolveStatus::singular);
  EXPECT_EQ(failed_step(Midpoint<Skate>{}, {{}, {0.5, 0, 0.2}}), SolveStatus::singular);
}

}  // namespace
