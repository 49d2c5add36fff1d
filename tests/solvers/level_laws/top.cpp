// The laws of a momentum level where the connection is curved: the heavy top's.
#include "broken_laws.hpp"

#include <lagroid/groupoids/connections.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../../support/hasty_solver.hpp"

#include <gtest/gtest.h>

#include <memory>

using namespace lagroid;

namespace level_laws_top_tests {
namespace {

template <class Connection> MomentumLevel<Connection, HeavyTop> level_of_the_top() {
  HeavyTop top;
  top.h = 0.05;
  return {Connection{}, top, Vector<double, 1>(0)};
}
State<HeavyTop::GroupoidType> draw_top() {
  const Vector<double, 3> up(0.6 + 0.3 * laws::draw_uniform(), 0.4 * laws::draw_uniform(), 0.8);
  return {up.normalized(), {laws::draw_uniform(), laws::draw_uniform(), 2 + laws::draw_uniform()}};
}

TEST(LevelLaws, OfTheHeavyTop) {
  const auto report = laws::level_laws(level_of_the_top<ShortestRotation>(), draw_top);
  EXPECT_TRUE(report.holds()) << report;
}

/// Its angles are a hundredth too large, and so is the holonomy of which the magnetic term is made.
struct Stretched : ShortestRotation {
  template <class S> Vector<S, 1> angle(const ActionArrow<Matrix<S, 3, 3>, Vector<S, 3>>& g) const {
    return ShortestRotation::angle(g) * 1.01;
  }
};
TEST(BrokenLevel, OfAnotherMagneticTermIsFoundOut) {
  EXPECT_EQ(broken_laws(laws::level_laws(level_of_the_top<Stretched>(), draw_top)),
            Names{"the Routhian and its magnetic term give the momenta"});
}

TEST(BrokenLevel, OfAHastySolverIsFoundOut) {
  using Level = MomentumLevel<ShortestRotation, HeavyTop>;
  const auto report = laws::level_laws(level_of_the_top<ShortestRotation>(), draw_top, 1e-10,
                                       [] { return std::make_unique<Hasty<Level>>(); });
  EXPECT_EQ(broken_laws(report), Names{"the computed step is Poisson, with the magnetic term"});
}

}  // namespace
}  // namespace level_laws_top_tests
