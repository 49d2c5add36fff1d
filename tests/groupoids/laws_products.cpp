// The groupoid laws on products, trivial and time-extended groupoids.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/groupoids/trivial.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_products_tests {
namespace {

template <class G> class GroupoidLaws : public ::testing::Test {};

using Subjects = ::testing::Types<Trivial<2, SO3>, Product<VectorGroup<1>, Pair<1>, SO2>, TimeExtended<SE2>,
                                  TimeExtended<Product<Pair<1>, SO2>>>;
TYPED_TEST_SUITE(GroupoidLaws, Subjects);

TYPED_TEST(GroupoidLaws, Hold) {
  const auto report = laws::groupoid_laws<TypeParam>();
  EXPECT_TRUE(report.holds()) << report;
}

TEST(Product, NamesItsFactors) { EXPECT_EQ((Product<Pair<2>, SO3>::name()), "Pair<2> x SO(3)"); }

TEST(Product, CoordinateScaleIsPerFactor) {
  const Product<Pair<1>, SO2> groupoid;
  const ArrowOf<Product<Pair<1>, SO2>> g{PairArrow<double, 1>{Vector<double, 1>(2000.0), Vector<double, 1>(-5.0)},
                                         Matrix<double, 2, 2>::Identity()};
  EXPECT_EQ(groupoid.coordinate_scale(g), (Vector<double, 2>(2000, 1)));
}

TEST(Anchor, OfAProductSeesOnlyTheObjects) {
  const Product<Pair<2>, SO3> groupoid;
  const ObjectOf<Product<Pair<2>, SO3>> q{Vector<double, 2>(1, 2), {}};
  const Vector<double, 5> x(1, 2, 3, 4, 5);
  EXPECT_EQ(groupoid.anchor(q, x), (Vector<double, 2>(1, 2)));
}

}  // namespace
}  // namespace groupoids_laws_products_tests
