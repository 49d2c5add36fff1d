// The orders of Hamiltonian Taylor integrators of a pendulum, min(r + 1, that of the quadrature), measured.
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace types_on_groupoids_orders_tests {
namespace {

using enum GeneratingType;
using namespace quadrature_rules;

template <class Sys> Case<Sys> swing() {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  const auto force = [](const auto& q, const auto&, double) { return Vector<double, 1>(-std::sin(q(0))); };
  const State<Pair<1>> end = reference_motion(1.0, force, start, 3.0);
  return {Sys{}, start, 3, Eigen::Vector2d(end.object(0), end.momentum(0))};
}
TEST(TypesOnGroupoids, OrdersOnThePendulum) {
  using H = SwingByMomentum;
  expect_order(swing<HamiltonianTaylor<H, 0>>(), 400);
  expect_order(swing<HamiltonianTaylor<H, 1>>(), 40);
  expect_order(swing<HamiltonianTaylor<H, 1, three>>(), 40);
  expect_order(swing<HamiltonianTaylor<H, 2, two, gauss_2>>(), 40);
  expect_order(swing<HamiltonianTaylor<H, 3, two, gauss_2>>(), 20);
}

TEST(TypesOnGroupoids, OrderOnASphereIsTwo) {
  const Vector<double, 3> end = bead_end(2);
  const auto bead = [&]<class Sys>(Sys system) { return Case<Sys>{system, bead_start, 2, end}; };
  expect_order(bead(HamiltonianTaylor<BeadByMomentum, 1>{}), 20, 0.1, 1e-6);
  expect_order(bead(HamiltonianTaylor<BeadByMomentum, 3, two, gauss_2>{}), 20, 0.1, 1e-6);
}

}  // namespace
}  // namespace types_on_groupoids_orders_tests
