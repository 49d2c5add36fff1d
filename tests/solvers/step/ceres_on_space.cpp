// Steps by Ceres on the groups of more dimensions.
#include "ceres_on.hpp"

#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se3.hpp>

using namespace lagroid;

namespace step_ceres_on_space_tests {
namespace {

template <class G> class CeresInSpace : public ::testing::Test {};

using Groups = ::testing::Types<SE3, SpecialEuclidean3<Retraction::cayley>, Orthogonal<4>>;
TYPED_TEST_SUITE(CeresInSpace, Groups);

TYPED_TEST(CeresInSpace, SolvesTwoThousandStepsAsNewtonDoes) { expect_ceres_to_solve_as_newton<TypeParam>({}); }

}  // namespace
}  // namespace step_ceres_on_space_tests
