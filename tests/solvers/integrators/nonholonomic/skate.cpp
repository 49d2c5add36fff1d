// A skate on a sphere: a nonholonomic constraint beside one on objects.
#include "../../../support/on_a_sphere.hpp"

#include <lagroid/solvers/testing/dalembert_laws.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace nonholonomic_skate_tests {
namespace {

TEST(Nonholonomic, BesideAnObjectConstraintDoesNoVirtualWork) {
  const auto report = laws::dalembert_laws(SkateOnASphere{}, draw_skate);
  EXPECT_TRUE(report.holds()) << report;
}

/// Derivatives by hand that forget that the sphere allows no displacement across it.
struct Sinking : SkateOnASphere {
  TwoSided<3, 2> two_sided(const PairArrow<double, 3>& g, const Multipliers& lambda) const {
    auto d = automatic_two_sided(static_cast<const SkateOnASphere&>(*this), g, lambda);
    d.source_gradient.array() += 0.1;
    return d;
  }
  Step<Sinking> first_guess(const State<Pair<3>>& s) const {
    return {SkateOnASphere::first_guess(s).arrow, Multipliers::Zero()};
  }
};
TEST(BrokenReaction, BesideAnObjectConstraintDoesVirtualWork) {
  const auto report = laws::dalembert_laws(Sinking{}, draw_skate);
  EXPECT_FALSE(report.law("no virtual work").holds()) << report;
}

}  // namespace
}  // namespace nonholonomic_skate_tests
