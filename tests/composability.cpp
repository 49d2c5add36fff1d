// Built with LAGROID_CHECKED: composing arrows that do not compose is caught.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/so3.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace {

TEST(CheckedBuild, RefusesArrowsThatDoNotCompose) {
  static_assert(checked_build);
  const Pair<2> groupoid;
  const PairArrow<double, 2> g{{0, 0}, {1, 0}};
  const PairArrow<double, 2> h{{1, 0.5}, {2, 2}};
  try {
    groupoid.compose(g, h);
    FAIL() << "composed";
  } catch (const NotComposable& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("Pair<2>"), std::string::npos) << message;
    EXPECT_NE(message.find("1 0.5"), std::string::npos) << message;
    EXPECT_NE(message.find("0.5 apart"), std::string::npos) << message;
  }
}

TEST(CheckedBuild, AllowsRoundOffAndEverythingOnGroups) {
  const Pair<1> groupoid;
  EXPECT_NO_THROW(groupoid.compose(PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(1e6)},
                                   PairArrow<double, 1>{Vector<double, 1>(1e6 + 1e-9), Vector<double, 1>(3.0)}));
  const SO3 rotations;
  EXPECT_NO_THROW(rotations.compose(SO3::exp(Vector<double, 3>(1, 2, 3)), SO3::exp(Vector<double, 3>(0, 1, 0))));
}

TEST(CheckedBuild, SeesThroughProducts) {
  const Product<Pair<1>, SO3> groupoid;
  const auto r = SO3::exp(Vector<double, 3>(1, 2, 3));
  const ArrowOf<Product<Pair<1>, SO3>> g{PairArrow<double, 1>{Vector<double, 1>(0.0), Vector<double, 1>(1.0)}, r};
  EXPECT_THROW(groupoid.compose(g, g), NotComposable);
}

}  // namespace
