// Object constraints along curves of high order: the pair Lobatto IIIA-IIIB.
#include <lagroid/solvers/galerkin/galerkin.hpp>

#include "../laws.hpp"
#include "../subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_lobatto_pair_tests {
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

}  // namespace
}  // namespace exact_actions_lobatto_pair_tests
