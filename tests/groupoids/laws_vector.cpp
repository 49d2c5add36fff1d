// The groupoid laws on shipped groupoids.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_vector_tests {
namespace {

template <class G> class LawsOfVectors : public ::testing::Test {};

using Subjects = ::testing::Types<Pair<1>, Pair<2>, Pair<3>, VectorGroup<2>, VectorGroup<3>>;
TYPED_TEST_SUITE(LawsOfVectors, Subjects);

TYPED_TEST(LawsOfVectors, Hold) {
  const auto report = laws::groupoid_laws<TypeParam>();
  EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace groupoids_laws_vector_tests
