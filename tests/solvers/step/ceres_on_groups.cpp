// Steps by Ceres on vectors and the matrix groups of the plane and of rotations.
#include "ceres_on.hpp"

#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>

using namespace lagroid;

namespace step_ceres_on_groups_tests {
namespace {

template <class G> class CeresOnGroups : public ::testing::Test {};

using Groups = ::testing::Types<VectorGroup<2>, SO2, SpecialOrthogonal3<Retraction::exponential>,
                                SpecialOrthogonal3<Retraction::cayley>, SE2, SpecialEuclidean2<Retraction::cayley>,
                                Linear<2>, SpecialLinear<2>>;
TYPED_TEST_SUITE(CeresOnGroups, Groups);

TYPED_TEST(CeresOnGroups, SolvesTwoThousandStepsAsNewtonDoes) { expect_ceres_to_solve_as_newton<TypeParam>({}); }

}  // namespace
}  // namespace step_ceres_on_groups_tests
