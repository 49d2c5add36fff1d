// Arrow constraints at every point of a curve: orders, multipliers, momenta; object constraints by the trapezoid.
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

/// The order of a system with nodes beside its arrows, on its own states.
template <class Sys, class L> void expect_order_on_nodes(const Case<Sys>& c, const L&, int coarsest, double tolerance) {
  laws::OrderProblem problem;
  problem.exact = c.exact;
  problem.coarsest = coarsest;
  problem.end = [&](int steps) {
    Sys system = c.system;
    system.h = c.horizon / steps;
    auto run = make(system, c.start);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged()) << k;
    const auto s = Sys::reduced(run.point().state);
    Eigen::VectorXd out(c.exact.size());
    out << system.base().coordinates_of_object(s.object), s.momentum;
    return out;
  };
  const auto report = laws::order_laws(Sys::traits(), problem, tolerance);
  const double order = laws::measured_order(problem);
  EXPECT_TRUE(report.holds()) << report << " saw " << order;
  std::cout << "  " << Sys::traits().name << ": declared " << Sys::traits().order << ", measured " << order << '\n';
}

const State<Pair<3>> area_start{{0.8, -0.3, 0.1}, {0.5, 0.9, 1.3}};

/// mu = dl + lambda dpsi: p_x = x' + lambda y / 2, p_y = y' - lambda x / 2, p_z = lambda.
Eigen::VectorXd area_end(double t) {
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const double lambda = y(5);
    const double u = y(3) - lambda * y(1) / 2;
    const double v = y(4) + lambda * y(0) / 2;
    dy << u, v, (y(0) * v - y(1) * u) / 2, -y(0) / 2 - 0.4 * y(0) * y(1) * y(1) - lambda * v / 2,
        -2 * y(1) / 3 - 0.4 * y(0) * y(0) * y(1) + lambda * u / 2, 0;
  };
  Eigen::VectorXd y(6);
  y << area_start.object, area_start.momentum;
  return integrate_reference(rates, y, t);
}
template <class Sys> Case<Sys> area() { return {Sys{}, Sys::extended(area_start), 3, area_end(3)}; }

TEST(AnyLagrangian, OrdersWithAConstraintThatCannotBeIntegrated) {
  expect_order(Case<Midpoint<Area>>{Midpoint<Area>{}, area_start, 3, area_end(3)}, 40);
  expect_order(Case<Trapezoidal<Area>>{Trapezoidal<Area>{}, area_start, 3, area_end(3)}, 40);
  expect_order_on_nodes(area<GalerkinOnNodes<Area, 2>>(), Area{}, 15, 0.1);
  expect_order_on_nodes(area<GalerkinOnNodes<Area, 3>>(), Area{}, 9, 0.1);
}

/// w = M, M' = -p2, p1' = w p2, p2' = -w p1.
TEST(AnyLagrangian, OrdersOfEulersElastica) {
  const Vector<double, 3> mu(0.5, 1.2, -0.7);
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy << -y(2), y(0) * y(2), -y(0) * y(1); };
  const Eigen::VectorXd end = integrate_reference(rates, mu, 3.0);
  expect_order(Case<Midpoint<Elastica>>{Midpoint<Elastica>{}, {{}, mu}, 3, end}, 40);
  using Four = GalerkinOnNodes<Elastica, 2>;
  expect_order_on_nodes(Case<Four>{Four{}, Four::extended({{}, mu}), 3, end}, Elastica{}, 15, 0.1);
  using Six = GalerkinOnNodes<Elastica, 3>;
  expect_order_on_nodes(Case<Six>{Six{}, Six::extended({{}, mu}), 3, end}, Elastica{}, 8, 0.1);
}

// p_z does not change and is every multiplier; psi is zero at every point of the curve, and the nodes' momenta stay
// zero.
TEST(AnyLagrangian, ConstraintsHoldAtEveryPointAndMultipliersAreThoseOfTheProblem) {
  using Sys = GalerkinOnNodes<Area, 3>;
  const Sys system{Area{}, 0.05};
  auto run = make(system, Sys::extended(area_start));
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& p = run.point();
    EXPECT_EQ(p.state.momentum.tail<6>().norm(), 0);
    EXPECT_NEAR(p.state.momentum(2), 1.3, 1e-13);
    for (double lambda : p.step.multipliers) EXPECT_NEAR(lambda, 1.3, 1e-10);
    EXPECT_LT(system.constraint(p.step.arrow).norm() / system.h, 1e-13);
  }
}
// The Noether momenta of a left-invariant problem: Ad* mu in space.
TEST(AnyLagrangian, TheForceOfAnElasticaIsKeptInSpace) {
  using Sys = GalerkinOnNodes<Elastica, 2>;
  const Sys system{Elastica{}, 0.1};
  const Vector<double, 3> mu(0.5, 1.2, -0.7);
  auto run = make(system, Sys::extended({{}, mu}));
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& p = run.point();
    const Matrix<double, 3, 3> g = std::get<0>(p.configuration);
    const Vector<double, 3> in_space = SE2::adjoint(SE2::inverse(g)).transpose() * p.state.momentum.head<3>();
    EXPECT_LT((in_space - mu).norm(), 1e-11) << k;
  }
}

/// A bead on the unit sphere under gravity: v^2 / 2 - z, |q|^2 = 1.
struct Bead : ContinuousLagrangian<Pair<3>, 0, 1> {
  template <class S> S l(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return (v(0) * v(0) + v(1) * v(1) + v(2) * v(2)) * 0.5 - q(2);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q(0) * q(0) + q(1) * q(1) + q(2) * q(2) - 1.0) * 0.5);
  }
};
TEST(AnyLagrangian, ObjectConstraintsHoldAndTheOrderIsTwo) {
  const State<Pair<3>> start{{0.6, 0, -0.8}, {0, 0.7, 0}};
  // q'' = -e3 + (q_3 - |v|^2) q
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    dy.head<3>() = y.tail<3>();
    dy.tail<3>() = (y(2) - y.tail<3>().squaredNorm()) * y.head<3>();
    dy(5) -= 1;
  };
  Eigen::VectorXd y(6);
  y << start.object, start.momentum;
  const Eigen::VectorXd end = integrate_reference(rates, y, 4.0);
  expect_order(Case<Trapezoidal<Bead>>{Trapezoidal<Bead>{}, start, 4, Eigen::VectorXd(end.head<3>())}, 40);
  expect_order(Case<Midpoint<Bead>>{Midpoint<Bead>{}, start, 4, Eigen::VectorXd(end.head<3>())}, 40);
}

}  // namespace
