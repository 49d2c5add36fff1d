// Object constraints along curves of high order: the pair Lobatto IIIA-IIIB.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "../laws.hpp"
#include "../subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace {

template <class L, int Stages> using LobattoPair = Galerkin<L, Stages, CurveQuadrature::lobatto_pair>;

TEST(AnyLagrangian, OrdersOnASphereByLobattosPair) {
  const Vector<double, 3> end = bead_end(4);
  expect_order(Case<LobattoPair<Bead, 2>>{LobattoPair<Bead, 2>{}, bead_start, 4, end}, 40);
  expect_order(Case<LobattoPair<Bead, 3>>{LobattoPair<Bead, 3>{}, bead_start, 4, end}, 15);
  expect_order(Case<LobattoPair<Bead, 4>>{LobattoPair<Bead, 4>{}, bead_start, 4, end}, 10);
  expect_order(Case<LobattoPair<Bead, 5>>{LobattoPair<Bead, 5>{}, bead_start, 4, end}, 6, 0.3, 1e-12);
}

TEST(AnyLagrangian, CurvesKeepObjectConstraintsAtEveryPoint) {
  const LobattoPair<Bead, 4> system{Bead{}, 0.2};
  auto run = make(system, bead_start);
  const double energy = system.energy(bead_start);
  for (int k = 0; k < 2000; ++k) {
    const Vector<double, 3> from = run.point().state.object;
    ASSERT_TRUE(run.advance().converged()) << k;
    const Vector<double, 3> to = run.point().state.object;
    EXPECT_NEAR(to.squaredNorm(), 1, 1e-13);
    const Vector<double, 11> between = system.nodes({from, to});  // three nodes and two multipliers
    const auto& rule = CurveRule<4, CurveQuadrature::lobatto_pair>::rule();
    for (std::size_t i = 1; i < 3; ++i) {
      Vector<double, 3> x = rule.value[i][4] * (to - from);
      for (std::size_t j = 1; j < 4; ++j) x += rule.value[i][j] * between.segment<3>(3 * int(j - 1));
      EXPECT_NEAR((from + x).squaredNorm(), 1, 1e-13);
    }
    const Vector<double, 3> q = to;
    State<Pair<3>> tangent = run.point().state;
    tangent.momentum -= q * q.dot(tangent.momentum);
    EXPECT_NEAR(system.energy(tangent), energy, 1e-5) << k;
    EXPECT_NEAR(q(0) * tangent.momentum(1) - q(1) * tangent.momentum(0), 0.42, 1e-12);
  }
}

TEST(AnyLagrangian, LawsOfABeadByLobattosPair) {
  expect_laws(LobattoPair<Bead, 3>{Bead{}, 0.1}, [] {
    const auto drawn = [] {
      return Vector<double, 3>(laws::draw_uniform(), laws::draw_uniform(), 1.5 + laws::draw_uniform());
    };
    const Vector<double, 3> q = drawn().normalized();
    const Vector<double, 3> p = drawn();
    return State<Pair<3>>{q, p - q * q.dot(p)};
  });
}

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
