// The laws of exact derivatives, on a pair groupoid and on one with a bracket.

#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_laws_tests {
namespace {

using laws::draw_uniform;

TEST(SensitivityLaws, HoldOnPairs) {
  Kepler kepler;
  kepler.h = 0.05;
  const auto report = laws::sensitivity_laws(kepler, [] {
    return State<Pair<2>>{{1 + 0.2 * draw_uniform(), 0.2 * draw_uniform()}, {0.3 * draw_uniform(), 1}};
  });
  EXPECT_TRUE(report.holds()) << report;
  EXPECT_EQ(report.laws.size(), 4U);
}

TEST(SensitivityLaws, HoldOnAGroupoidWithABracket) {
  HeavyTop top;
  top.h = 0.05;
  top.inertia = {1.1, 0.9, 0.6};
  top.weight = {0.1, -0.2, 1};
  const auto report = laws::sensitivity_laws(top, [] {
    return State<HeavyTop::GroupoidType>{Vector<double, 3>(0.5 * draw_uniform(), 0.5 * draw_uniform(), 1).normalized(),
                                         {draw_uniform(), draw_uniform(), 2 * draw_uniform()}};
  });
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace lagroid::sensitivity_laws_tests
