// Degenerate Lagrangians are a status, and never a number.
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_degenerate_tests {
namespace {

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
}  // namespace continuous_lagrangian_degenerate_tests
