// Orders of the rules, measured: on groups with both retractions, and ten where the others end at eight.
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/systems/reference.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace continuous_lagrangian_orders_on_groups_tests {
namespace {

/// v^2 / 2 - q^2 / 2 - 3 q^4 / 400, whose errors of order ten are seen before round-off is.
struct Spring : ContinuousLagrangian<Pair<1>> {
  template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
    const S square = q(0) * q(0);
    return v(0) * v(0) * 0.5 - square * 0.5 - square * square * 0.0075;
  }
};
template <class Sys> Case<Sys> spring() {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.1)};
  const auto force = [](const auto& q, const auto&, double) {
    return Vector<double, 1>(-q(0) - 0.03 * q(0) * q(0) * q(0));
  };
  const State<Pair<1>> end = reference_motion(1.0, force, start, 40.0);
  return {Sys{}, start, 40, Eigen::Vector2d(end.object(0), end.momentum(0))};
}
TEST(AnyLagrangian, OrderTenOnASpring) {
  expect_order(spring<Galerkin<Spring, 5>>(), 36, 0.3, 1e-12);
  expect_order(spring<Galerkin<Spring, 5, CurveQuadrature::lobatto>>(), 36, 0.3, 1e-12);
}

/// M' = M x w, A' = A hat(w).
template <class Sys> Case<Sys> body(double horizon = 4) {
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto none = [](const auto&, const auto&) { return Vector<double, 3>(0, 0, 0); };
  const Vector<double, 3> end = reference_turn({1, 2, 3}, none, start.momentum, attitude, horizon);
  Eigen::VectorXd exact(12);
  exact << end, attitude.reshaped();
  return {Sys{}, {{}, start.momentum}, horizon, exact};
}
TEST(AnyLagrangian, OrdersOnTheFreeBody) {
  expect_order(body<Midpoint<FreeBody<SO3>>>(), 40);
  expect_order(body<Galerkin<FreeBody<SO3>, 2>>(), 12);
  expect_order(body<Galerkin<FreeBody<SO3>, 3>>(), 8);
  expect_order(body<Galerkin<FreeBody<SO3>, 4>>(8), 7, 0.3);
}
TEST(AnyLagrangian, OrdersOnTheFreeBodyByCayleysMap) {
  using Group = SpecialOrthogonal3<Retraction::cayley>;
  expect_order(body<Trapezoidal<FreeBody<Group>>>(), 40);
  expect_order(body<Galerkin<FreeBody<Group>, 2>>(), 12);
  expect_order(body<Galerkin<FreeBody<Group>, 3, CurveQuadrature::lobatto>>(), 8);
}

/// A body in an ideal fluid: mu' = ad_xi^T mu on se(3), mu = M xi with M of no symmetry.
struct Submerged : ContinuousLagrangian<SE3> {
  static Matrix<double, 6, 6> mass() {
    Matrix<double, 6, 6> m = Vector<double, 6>(1, 2, 3, 1.5, 2.5, 2).asDiagonal();
    m(0, 4) = m(4, 0) = 0.3;
    m(1, 5) = m(5, 1) = -0.2;
    return m;
  }
  template <class S> S l(const Vector<S, 0>&, const Vector<S, 6>& xi) const {
    const Matrix<double, 6, 6> m = mass();
    S sum(0.0);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (m(i, j) != 0) sum += xi(i) * xi(j) * (0.5 * m(i, j));
    return sum;
  }
};
TEST(AnyLagrangian, OrderOfABodyInAFluid) {
  Vector<double, 6> mu;
  mu << 0.4, 1, 0.3, 0.5, -0.6, 0.8;
  const Matrix<double, 6, 6> inverse = Submerged::mass().inverse();
  const auto rates = [&](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const Vector<double, 6> m = y;
    const Vector<double, 6> xi = inverse * m;
    dy = SE3::ad<double>(xi).transpose() * m;
  };
  using Sys = Galerkin<Submerged, 2>;
  expect_order(Case<Sys>{Sys{}, {{}, mu}, 2, integrate_reference(rates, mu, 2.0)}, 8);
}

}  // namespace
}  // namespace continuous_lagrangian_orders_on_groups_tests
