// The groupoid laws on shipped groupoids.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so2.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_plane_tests {
namespace {

template <class G> class GroupoidLaws : public ::testing::Test {};

// The other retraction of each: laws_space.cpp.
using Subjects = ::testing::Types<SpecialOrthogonal2<Retraction::cayley>, SE2>;
TYPED_TEST_SUITE(GroupoidLaws, Subjects);

TYPED_TEST(GroupoidLaws, Hold) {
  const auto report = laws::groupoid_laws<TypeParam>();
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace groupoids_laws_plane_tests
