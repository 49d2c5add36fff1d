// Discretised Lagrangians beside other ways to the same step; derivatives by parameters and in charts.
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "same_step.hpp"
#include "subjects.hpp"

#include <array>

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_methods_tests {
namespace {

TEST(AnyLagrangian, InnerNodesInsideOrBesideTheArrowGiveOneStep) {
  expect_same_step<Orbit, 3>({{1, 0}, {0, 1.1}}, 0.2, 20);
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

}  // namespace
}  // namespace continuous_lagrangian_methods_tests
