// Arrow constraints on a group: orders, momenta; object constraints by the rules of order two.
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

TEST(AnyLagrangian, OrdersOfEulersElastica) {
  expect_order(Case<Midpoint<Elastica>>{Midpoint<Elastica>{}, {{}, elastica_start}, 3, elastica_end(3)}, 40);
  using Four = GalerkinOnNodes<Elastica, 2>;
  expect_order_on_nodes(Case<Four>{Four{}, Four::extended({{}, elastica_start}), 3, elastica_end(3)}, 15, 0.1);
}

// The Noether momenta of a left-invariant problem: Ad* mu in space.
TEST(AnyLagrangian, TheForceOfAnElasticaIsKeptInSpace) {
  using Sys = GalerkinOnNodes<Elastica, 2>;
  const Sys system{Elastica{}, 0.1};
  auto run = make(system, Sys::extended({{}, elastica_start}));
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& p = run.point();
    const Matrix<double, 3, 3> g = std::get<0>(p.configuration);
    const Vector<double, 3> in_space = SE2::adjoint(SE2::inverse(g)).transpose() * p.state.momentum.head<3>();
    EXPECT_LT((in_space - elastica_start).norm(), 1e-11) << k;
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
