// Object constraints along curves of an action groupoid: the pair Lobatto IIIA-IIIB.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "../subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_guided_top_tests {
namespace {

template <class L, int Stages> using LobattoPair = Galerkin<L, Stages, CurveQuadrature::lobatto_pair>;

/// A top whose vertical stays in a plane of the body: one equation for objects of an action groupoid.
struct Guided : ContinuousLagrangian<Action<SO3, RotatedDirections>, 0, 1> {
  template <class S> S l(const Vector<S, 3>& v, const Vector<S, 3>& w) const {
    return (w(0) * w(0) + w(1) * w(1) * 1.3 + w(2) * w(2) * 0.5) * 0.5 - v(0) * 0.2 - v(2);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& v) const {
    return Vector<S, 1>(v(1) - v(2) * 0.5 + v(0) * v(0) * 0.3);
  }
};
TEST(AnyLagrangian, OrdersOfAGuidedTopByLobattosPair) {
  Vector<double, 3> on(0.4, 0.4, 0.8);  // then on both the sphere and the guide
  for (int pass = 0; pass < 60; ++pass) {
    on(1) = on(2) * 0.5 - on(0) * on(0) * 0.3;
    on.normalize();
  }
  State<Guided::GroupoidType> start{on, {0, 0, 0}};
  // Momenta of velocities that keep the guide: w with dC/dv . (v x w) = 0.
  const Vector<double, 3> slope(0.6 * on(0), 1, -0.5);
  const Vector<double, 3> normal = slope.cross(on);
  Vector<double, 3> w(0.9, 0.2, -0.4);
  w -= normal * normal.dot(w) / normal.squaredNorm();
  start.momentum = w.cwiseProduct(Vector<double, 3>(1, 1.3, 0.5));
  LobattoPair<Guided, 5> fine{Guided{}, 2.0 / 40};
  auto run = make(fine, start);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(run.advance().converged());
  const Eigen::VectorXd end = run.point().state.object;
  expect_order(Case<LobattoPair<Guided, 2>>{LobattoPair<Guided, 2>{}, start, 2, end}, 40);
  expect_order(Case<LobattoPair<Guided, 3>>{LobattoPair<Guided, 3>{}, start, 2, end}, 12);
  expect_order(Case<LobattoPair<Guided, 4>>{LobattoPair<Guided, 4>{}, start, 2, end}, 8);
}

}  // namespace
}  // namespace exact_actions_guided_top_tests
