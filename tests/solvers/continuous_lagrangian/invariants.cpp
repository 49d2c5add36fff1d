// What steps of discretised Lagrangians keep: momenta, the way back; and that they allocate nothing.
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "../../support/allocation_counter.hpp"
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_invariants_tests {
namespace {

// Momenta that symmetries keep, to round-off, over a thousand steps; the energy in a band.
TEST(AnyLagrangian, KeepsMomenta) {
  const Galerkin<Orbit, 4> system{Orbit{}, 0.3};
  auto run = make(system, State<Pair<2>>{{1, 0}, {0, 1.2}});
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& s = run.point().state;
    EXPECT_NEAR(s.object(0) * s.momentum(1) - s.object(1) * s.momentum(0), 1.2, 1e-13);
    EXPECT_NEAR(system.energy(s), 0.72 - 1, 1e-7);
  }
}
TEST(AnyLagrangian, KeepsSpatialMomenta) {
  using Sys = Galerkin<FreeBody<SO3>, 3>;
  const Sys system{FreeBody<SO3>{}, 0.3};
  const Vector<double, 3> start(0.3, 1.5, 0.4);
  auto run = make(system, State<SO3>{{}, start});
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    EXPECT_LT((run.point().configuration * run.point().state.momentum - start).norm(), 1e-12) << k;
  }
}

/// Whether steps and steps back end where they began: what a method that declares symmetry must do.
template <class Sys> double return_defect(Sys system, const State<typename Sys::GroupoidType>& start, int steps) {
  auto run = make(system, start);
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged());
  system.h = -system.h;
  auto back = make(system, run.point().state);
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(back.advance().converged());
  return (back.point().state.momentum - start.momentum).norm();
}
TEST(AnyLagrangian, ReturnsWhereItDeclaresSymmetry) {
  const State<Pair<2>> orbit{{1, 0}, {0, 1.1}};
  const State<Top::GroupoidType> top{{0, 0.6, 0.8}, {0.4, 0.2, 1.5}};
  EXPECT_TRUE((Galerkin<Orbit, 3>::traits().symmetric));
  EXPECT_LT(return_defect(Galerkin<Orbit, 3>{Orbit{}, 0.3}, orbit, 10), 1e-12);
  EXPECT_LT(return_defect(Galerkin<Orbit, 3, CurveQuadrature::lobatto>{Orbit{}, 0.3}, orbit, 10), 1e-12);
  EXPECT_TRUE(Midpoint<Top>::traits().symmetric);
  EXPECT_LT(return_defect(Midpoint<Top>{Top{}, 0.3}, top, 10), 1e-12);
  EXPECT_LT(return_defect(Trapezoidal<Top>{Top{}, 0.3}, top, 10), 1e-12);
  // A polynomial in the chart at one end is none in the chart at the other, unless the group is abelian.
  EXPECT_FALSE((Galerkin<Top, 2>::traits().symmetric));
  EXPECT_GT(return_defect(Galerkin<Top, 2>{Top{}, 0.3}, top, 10), 1e-9);
}

TEST(AnyLagrangian, AStepAllocatesNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const auto expect_none = [](auto run) {
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(run.advance().converged());
    const long before = allocation_count();
    for (int k = 0; k < 50; ++k) ASSERT_TRUE(run.advance().converged());
    EXPECT_EQ(allocation_count() - before, 0);
  };
  expect_none(make(Galerkin<Orbit, 4>{Orbit{}, 0.1}, State<Pair<2>>{{1, 0}, {0, 1.1}}));
  expect_none(make(Galerkin<Top, 2>{Top{}, 0.1}, State<Top::GroupoidType>{{0, 0.6, 0.8}, {0.4, 0.2, 1.5}}));
  expect_none(make(Galerkin<FreeBody<SO3>, 3>{FreeBody<SO3>{}, 0.1}, State<SO3>{{}, {0.3, 1.5, 0.4}}));
  expect_none(make(Midpoint<Area>{Area{}, 0.1}, State<Pair<3>>{{0.8, -0.3, 0.1}, {0.5, 0.9, 1.3}}));
}

}  // namespace
}  // namespace continuous_lagrangian_invariants_tests
