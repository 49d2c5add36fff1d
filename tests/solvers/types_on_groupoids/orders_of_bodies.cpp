// The orders of Hamiltonian Taylor integrators of bodies, min(r + 1, that of the quadrature), measured.
#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace types_on_groupoids_orders_of_bodies_tests {
namespace {

using enum GeneratingType;
using namespace quadrature_rules;

template <class Sys> Case<Sys> body() {
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto none = [](const auto&, const auto&) { return Vector<double, 3>(0, 0, 0); };
  const Vector<double, 3> end = reference_turn({1, 2, 3}, none, start.momentum, attitude, 4);
  Eigen::VectorXd exact(12);
  exact << end, attitude.reshaped();
  return {Sys{}, start, 4, exact};
}
// Steps are dear: errors below are not looked for.
constexpr double coarse = 1e-5, fine = 1e-8;
TEST(TypesOnGroupoids, OrdersOnTheFreeBody) {
  expect_order(body<HamiltonianTaylor<FreeBodyByMomentum<SO3>, 1>>(), 40, 0.1, coarse);
  expect_order(body<HamiltonianTaylor<FreeBodyByMomentum<SO3>, 3, two, gauss_2>>(), 12, 0.1, fine);
}
TEST(TypesOnGroupoids, OrdersOnTheHeavyTop) {
  const auto top = []<class Sys>(Sys system) { return Case<Sys>{system, top_start, 2, top_end(2)}; };
  expect_order(top(HamiltonianTaylor<TopByMomentum, 1>{}), 20, 0.1, coarse);
  expect_order(top(HamiltonianTaylor<TopByMomentum, 2, three, gauss_2>{}), 12, 0.1, fine);
}

}  // namespace
}  // namespace types_on_groupoids_orders_of_bodies_tests
