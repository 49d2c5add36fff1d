// What a step does not survive is a status, and never a number: inner nodes that are not found, what is not finite.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "subjects.hpp"

#include <limits>

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_failures_tests {
namespace {

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

}  // namespace
}  // namespace continuous_lagrangian_failures_tests
