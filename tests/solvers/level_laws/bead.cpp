// The laws of a momentum level where the connection is flat: of a bead on a turning rod.
#include "broken_laws.hpp"

#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace level_laws_bead_tests {
namespace {

/// A bead at a distance r on a turning rod.
struct Bead : System<Bead, Product<Pair<1>, SO2>> {
  double h = 0.05;
  template <class S> S lagrangian(const Arrow<S>& g) const {
    const auto& [move, turn] = g;
    const S r = move.source(0);
    const S s = move.target(0);
    return (r * r + s * s - r * s * turn.trace()) * (0.5 / h) - (r * r + s * s) * (0.25 * h);
  }
};
State<Bead::GroupoidType> draw_bead() {
  return {{Vector<double, 1>(1.2 + 0.4 * laws::draw_uniform()), {}}, {laws::draw_uniform(), laws::draw_uniform()}};
}
template <class Connection> MomentumLevel<Connection, Bead> level_of_the_bead() {
  return {Connection{}, Bead{}, Vector<double, 1>(0)};
}

TEST(LevelLaws, OfABeadOnATurningRod) {
  const auto report = laws::level_laws(level_of_the_bead<FactorConnection<Factors<1>, Pair<1>, SO2>>(), draw_bead);
  EXPECT_TRUE(report.holds()) << report;
}

/// The bases are twice the horizontal lifts, and twice the direction of the angle: of second derivatives and of what is
/// above, for first derivatives are those of the Routhian.
struct Doubled : FactorConnection<Factors<1>, Pair<1>, SO2> {
  static Matrix<double, 2, 2> adapted_basis(const Vector<double, 1>&) { return 2 * Matrix<double, 2, 2>::Identity(); }
};

TEST(BrokenLevel, InAnotherBasisIsFoundOut) {
  EXPECT_EQ(broken_laws(laws::level_laws(level_of_the_bead<Doubled>(), draw_bead)),
            (Names{"second derivatives are those of the gradients", "steps are those of the full system",
                   "full arrows have the momentum of the level at both ends"}));
}

}  // namespace
}  // namespace level_laws_bead_tests
