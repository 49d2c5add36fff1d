// Discretised Lagrangians beside other ways to the same step; momenta, symmetry, allocations.
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/solvers/integrators/composition.hpp>

#include "../../support/allocation_counter.hpp"
#include "subjects.hpp"

#include <Eigen/LU>

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

// Eliminated inside or kept beside the arrow: the same step. The points are those of Gauss in both.
template <class L, int Degree>
void expect_same_step(const State<typename L::GroupoidType>& start, double h, int steps) {
  auto inside = make(Galerkin<L, Degree>{L{}, h}, start);
  using Beside = GalerkinOnNodes<L, Degree>;
  auto beside = make(Beside{L{}, h}, Beside::extended(start));
  for (int k = 0; k < steps; ++k) {
    ASSERT_TRUE(inside.advance().converged()) << k;
    ASSERT_TRUE(beside.advance().converged()) << k;
  }
  const auto s = Beside::reduced(beside.point().state);
  EXPECT_LT((inside.point().state.momentum - s.momentum).norm(), 1e-12);
  const auto& g = inside.system().groupoid;
  EXPECT_LT((g.coordinates_of_object(inside.point().state.object) - g.coordinates_of_object(s.object)).norm(), 1e-12);
}
TEST(AnyLagrangian, InnerNodesInsideOrBesideTheArrowGiveOneStep) {
  expect_same_step<Orbit, 3>({{1, 0}, {0, 1.1}}, 0.2, 20);
  expect_same_step<Top, 2>({{0, 0.6, 0.8}, {0.4, 0.2, 1.5}}, 0.2, 20);
}

// Hairer, Lubich, Wanner, VI.6.3: the step is that of Gauss's Runge-Kutta method on q' = p, p' = -sin q; here its two
// stages by fixed-point iteration.
TEST(AnyLagrangian, GaussIsTheRungeKuttaMethodOfGauss) {
  const double h = 0.3;
  double q = 1.2;
  double p = 0.3;
  auto run = make(Galerkin<Swing, 2>{Swing{}, h}, {Vector<double, 1>(q), Vector<double, 1>(p)});
  const double r = std::sqrt(3.0) / 6;
  for (int k = 0; k < 50; ++k) {
    Eigen::Vector2d dq(p, p);
    Eigen::Vector2d dp(-std::sin(q), -std::sin(q));
    Eigen::Matrix2d a;
    a << 0.25, 0.25 - r, 0.25 + r, 0.25;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d at = Eigen::Vector2d::Constant(q) + h * a * dq;
      dq = Eigen::Vector2d::Constant(p) + h * a * dp;
      dp = -at.array().sin();
    }
    q += h * dq.mean();
    p += h * dp.mean();
    ASSERT_TRUE(run.advance().converged());
    ASSERT_NEAR(run.point().state.object(0), q, 2e-14 * (k + 1));
    ASSERT_NEAR(run.point().state.momentum(0), p, 2e-14 * (k + 1));
  }
}

// Parameters are members, and derivatives with respect to them pass the inner solve: dL/dg against differences.
TEST(AnyLagrangian, ParametersVary) {
  using Sys = Galerkin<Swing, 3>;
  using V = Varied<1>;
  Sys system{Swing{}, 0.4};
  const auto g = PairArrow<double, 1>{Vector<double, 1>(1.0), Vector<double, 1>(1.3)};
  const std::array<const double*, 1> places{&system.gravity};
  const VariedMembers varied_now(places, 0);
  const auto along = [&](const PairArrow<Jet<V, 2>, 1>& moved) { return system.lagrangian(moved); };
  PairArrow<Jet<V, 2>, 1> moved{Vector<Jet<V, 2>, 1>(Jet<V, 2>::variable(V(1.0), 0)),
                                Vector<Jet<V, 2>, 1>(Jet<V, 2>::variable(V(1.3), 1))};
  const auto f = along(moved);
  const double e = 1e-4;
  const auto slope = [&](double by) {
    Sys other = system;
    other.gravity += by;
    return gradients(other, g, {}).target_gradient(0);
  };
  const double expected = (8 * (slope(e) - slope(-e)) - (slope(2 * e) - slope(-2 * e))) / (12 * e);
  EXPECT_NEAR(f.gradient(1).tangent(0), expected, 1e-10);
  EXPECT_NE(expected, 0);
}

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

template <class G> void expect_chart_velocity(const G& groupoid, const ObjectOf<G>& q) {
  for (int k = 0; k < 20; ++k) {
    AlgebroidVector<G> x;
    AlgebroidVector<G> rate;
    for (int i = 0; i < G::dimension; ++i) {
      x(i) = 0.8 * std::sin(1.3 * k + i);
      rate(i) = std::cos(0.7 * k - 2 * i);
    }
    const AlgebroidVector<G> slow = automatic_chart_velocity<double>(groupoid, q, x, rate);
    EXPECT_LT((curve_point<double>(groupoid, q, x, rate).velocity - slow).norm(), 1e-13) << G::name();
  }
}
TEST(AnyLagrangian, VelocitiesInClosedFormAreThoseOfTheRetraction) {
  expect_chart_velocity(Pair<2>{}, {0.3, 0.1});
  expect_chart_velocity(VectorGroup<3>{}, {});
  expect_chart_velocity(SO3{}, {});
  expect_chart_velocity(SpecialOrthogonal3<Retraction::cayley>{}, {});
  expect_chart_velocity(SE2{}, {});
  expect_chart_velocity(SE3{}, {});
  expect_chart_velocity(SpecialEuclidean3<Retraction::cayley>{}, {});
  expect_chart_velocity(Top::GroupoidType{}, {0, 0.6, 0.8});
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
