// Arrow constraints on a group: orders, momenta; object constraints by the rules of order two.
#include <lagroid/solvers/galerkin/galerkin_on_nodes.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_constrained_tests {
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

TEST(AnyLagrangian, ObjectConstraintsHoldAndTheOrderIsTwo) {
  expect_order(Case<Trapezoidal<Bead>>{Trapezoidal<Bead>{}, bead_start, 4, bead_end(4)}, 40);
  expect_order(Case<Midpoint<Bead>>{Midpoint<Bead>{}, bead_start, 4, bead_end(4)}, 40);
}

}  // namespace
}  // namespace continuous_lagrangian_constrained_tests
