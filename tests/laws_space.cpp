// The groupoid laws on shipped groupoids.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/orthogonal.hpp>
#include <lagroid/groupoids/se3.hpp>
#include <lagroid/groupoids/so3.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace {

template <class G> class GroupoidLaws : public ::testing::Test {};

using Subjects = ::testing::Types<SO3, SpecialOrthogonal3<Retraction::cayley>, SE3,
                                  SpecialEuclidean3<Retraction::cayley>, Orthogonal<4>>;
TYPED_TEST_SUITE(GroupoidLaws, Subjects);

TYPED_TEST(GroupoidLaws, Hold) {
  const auto report = laws::groupoid_laws<TypeParam>();
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
