// Steps by Ceres on groupoids with objects: pairs, actions, products.
#include "ceres_on.hpp"

#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/trivial.hpp>

using namespace lagroid;

namespace {

TEST(CeresOnPairs, SolvesTwoThousandStepsAsNewtonDoes) {
  expect_ceres_to_solve_as_newton<Pair<2>>({0, 1});
  expect_ceres_to_solve_as_newton<PairOf<SO3>>(Matrix<double, 3, 3>::Identity());
}

TEST(CeresOnActions, SolvesTwoThousandStepsAsNewtonDoes) {
  expect_ceres_to_solve_as_newton<Action<SO3, RotatedVectors>>({0, 0, 1});
  expect_ceres_to_solve_as_newton<Action<SO3, RotatedDirections>>({0, 0, 1});
}

TEST(CeresOnProducts, SolvesTwoThousandStepsAsNewtonDoes) {
  expect_ceres_to_solve_as_newton<Trivial<2, SO3>>({Vector<double, 2>(0, 1), {}});
  expect_ceres_to_solve_as_newton<Product<SO2, SE2>>({});
}

}  // namespace
