// A groupoid that lives only here passes the laws, as a user's would; broken ones fail the law they break.
#include <lagroid/core/testing/groupoid_laws.hpp>

#include "../support/affine.hpp"
#include "../support/badly_framed.hpp"
#include "../support/broken.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_foreign_tests {
namespace {

TEST(ForeignGroupoid, PassesTheLaws) {
  const auto report = laws::groupoid_laws(Affine{}, moderate());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(ForeignGroupoid, SatisfiesTheConcept) {
  static_assert(Groupoid<Affine>);
  static_assert(!Groupoid<AffineArrow<double>>);
}

TEST(ForeignGroupoid, AnchorIsTheInfinitesimalAction) {
  const Affine groupoid;
  EXPECT_NEAR(groupoid.anchor(Vector<double, 1>(3.0), Vector<double, 2>(0.5, 0.25))(0), 0.5 * 3 + 0.25, 1e-15);
}

void expect_broken(Fault fault, const std::vector<std::string>& names) {
  Affine groupoid;
  groupoid.fault = fault;
  const auto report = laws::groupoid_laws(groupoid, moderate());
  for (const auto& law : names) EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

TEST(BrokenGroupoid, WrongSource) { expect_broken(Fault::source, {"left-invariant fields are alpha-vertical"}); }
TEST(BrokenGroupoid, WrongUnit) { expect_broken(Fault::unit, {"units", "tangent of the inversion (3)"}); }
TEST(BrokenGroupoid, WrongInverse) { expect_broken(Fault::inverse, {"inverses"}); }
TEST(BrokenGroupoid, WrongTarget) {
  expect_broken(Fault::target, {"source and target of products", "right-invariant fields are beta-vertical"});
}
TEST(BrokenGroupoid, WrongProduct) { expect_broken(Fault::product, {"source and target of products"}); }
TEST(BrokenGroupoid, WrongRetraction) { expect_broken(Fault::retraction, {"retraction", "chart"}); }
TEST(BrokenGroupoid, WrongInverseRetraction) { expect_broken(Fault::inverse_retraction, {"retraction"}); }
TEST(BrokenGroupoid, NotANumberInALaterComponent) {
  expect_broken(Fault::not_a_number, {"retraction", "correcting an arrow"});
}
TEST(BrokenGroupoid, RetractionThatLeavesItsFibre) { expect_broken(Fault::moves_its_source, {"retraction"}); }
TEST(BrokenGroupoid, WrongMomentumChange) { expect_broken(Fault::momentum_change, {"change of momentum"}); }
TEST(BrokenGroupoid, WrongExtension) { expect_broken(Fault::extension, {"extending an arrow"}); }
TEST(BrokenGroupoid, WrongSeed) { expect_broken(Fault::seed, {"closed-form translations"}); }

TEST(BrokenGroupoid, WrongFrame) {
  const auto expect_curved = [](const auto& report) {
    EXPECT_TRUE(report.law("arrow frame").holds()) << report;
    EXPECT_TRUE(laws::seen_broken(report.law("arrow frame, second order"))) << report;
  };
  expect_curved(laws::groupoid_laws<BadlyFramed<FrameFault::bracket>>());
  expect_curved(laws::groupoid_laws<BadlyFramed<FrameFault::curvature>>());
  EXPECT_TRUE(laws::seen_broken(laws::groupoid_laws<BadlyFramed<FrameFault::ends>>().law("arrow frame")));
}

/// R^2 with a product that is not associative.
struct NotAssociative : LieGroupoid<NotAssociative, 1> {
  template <class S> using Arrow = Vector<S, 1>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Object<S> source(const Vector<S, 1>&) { return {}; }
  template <class S> static Object<S> target(const Vector<S, 1>&) { return {}; }
  template <class S> static Vector<S, 1> unit(const Vector<S, 0>&) { return Vector<S, 1>(S(0)); }
  template <class S> static Vector<S, 1> inverse(const Vector<S, 1>& g) { return -g; }
  template <class S> static Vector<S, 1> multiply(const Vector<S, 1>& g, const Vector<S, 1>& h) {
    return Vector<S, 1>(g(0) + h(0) + g(0) * h(0) * (g(0) + h(0)));
  }
  template <class S> static Vector<S, 1> tau(const Vector<S, 0>&, const Vector<S, 1>& v) { return v; }
  template <class S> static Vector<S, 1> tau_inverse(const Vector<S, 1>& g) { return g; }
  static std::string name() { return "a loop"; }
};

TEST(BrokenGroupoid, NotAssociative) {
  const auto report = laws::groupoid_laws<NotAssociative>();
  EXPECT_TRUE(laws::seen_broken(report.law("associativity"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("left-invariant fields are invariant (1)"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("right-invariant fields are invariant (2)"))) << report;
}

/// A law of a number in [0, 1] that holds, and cannot be asked of the share above `most`.
laws::Law asked_below(double most) {
  return laws::check_law("numbers below a bound", 1, [most] {
    const double x = 0.5 * (1 + laws::draw_uniform());
    if (x > most) throw laws::NotSampled(x > 0.98 ? "far above" : "above");
    return x;
  });
}

TEST(Laws, OfWhichMoreThanAThirdOfTheSamplesArePassedOverAreUnjudged) {
  const auto most = asked_below(0.9);
  EXPECT_TRUE(most.holds()) << most.skipped << " of " << most.skipped + most.samples;
  EXPECT_GT(most.skipped, 0);
  const auto eighth = asked_below(0.125);
  EXPECT_FALSE(eighth.holds()) << eighth.skipped << " of " << eighth.skipped + eighth.samples;
  EXPECT_EQ(eighth.verdict(), "unjudged");
  EXPECT_EQ(eighth.skipped_because, "above") << "the commonest reason";
}
TEST(Laws, ThatAreBrokenAreNotUnjudgedHoweverManySamplesArePassedOver) {
  const auto law = laws::check_law("a number is none", 0.5, [] {
    if (laws::draw_uniform() > -0.8) throw laws::NotSampled("too large");
    return 1.0;
  });
  EXPECT_EQ(law.verdict(), "BROKEN");
}

}  // namespace
}  // namespace groupoids_laws_foreign_tests
