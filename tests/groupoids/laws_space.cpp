// The groupoid laws on shipped groupoids.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_space_tests {
namespace {

template <class G> class GroupoidLaws : public ::testing::Test {};

using Subjects =
    ::testing::Types<SO2, SpecialEuclidean2<Retraction::cayley>, SO3, SpecialOrthogonal3<Retraction::cayley>, SE3,
                     SpecialEuclidean3<Retraction::cayley>, Orthogonal<3>, Orthogonal<4>>;
TYPED_TEST_SUITE(GroupoidLaws, Subjects);

TYPED_TEST(GroupoidLaws, Hold) {
  const auto report = laws::groupoid_laws<TypeParam>();
  EXPECT_TRUE(report.holds()) << report;
}

/// exp makes elements of these groups that are far from orthogonal, and as badly conditioned.
template <class G> void expect_laws_near_the_identity() {
  laws::GroupoidLawOptions options;
  options.large = 0.5;
  options.local = 0.5;
  const auto report = laws::groupoid_laws(G{}, options);
  EXPECT_TRUE(report.holds()) << report;
}
TEST(LinearGroups, Hold) {
  expect_laws_near_the_identity<Linear<2>>();
  expect_laws_near_the_identity<SpecialLinear<3>>();
}

/// The suite draws what the retraction reaches: here are products with a reflection, det g = -1.
template <int N> void expect_both_components() {
  const Orthogonal<N> group;
  using Element = Matrix<double, N, N>;
  Element reflection = Element::Identity();
  reflection(0, 0) = -1;
  const auto element = [&](double first) {
    return group.tau({}, Vector<double, Orthogonal<N>::rank>::LinSpaced(first, 0.7).eval());
  };
  const Element g = group.compose(element(-0.3), reflection);
  const Element h = element(0.5);
  const Element k = group.compose(reflection, element(0.2));
  EXPECT_NEAR(g.determinant(), -1, 1e-14);
  EXPECT_NEAR(group.compose(g, k).determinant(), 1, 1e-14);
  const Element one = group.unit(Vector<double, 0>());
  EXPECT_EQ(group.compose(g, one), g);
  EXPECT_EQ(group.compose(one, g), g);
  EXPECT_LT((group.compose(g, group.inverse(g)) - one).norm(), 1e-14);
  EXPECT_LT((group.compose(group.inverse(g), g) - one).norm(), 1e-14);
  EXPECT_LT((group.compose(group.compose(g, h), k) - group.compose(g, group.compose(h, k))).norm(), 1e-14);
  EXPECT_LT((group.project(Element(g * (1 + 1e-9))) - g).norm(), 1e-14);
  const Vector<double, Orthogonal<N>::rank> x = Vector<double, Orthogonal<N>::rank>::LinSpaced(-1, 1);
  // X->(g) = g hat(Ad_{g^{-1}} x): the two families of fields are related by the adjoint on this component too.
  const Vector<double, Orthogonal<N>::rank> moved = group.adjoint(group.inverse(g)) * x;
  EXPECT_LT((group.right_invariant(g, x) - group.left_invariant(g, moved)).norm(), 1e-13);
}
TEST(Orthogonal, AxiomsOnBothComponents) {
  expect_both_components<3>();
  expect_both_components<4>();
  expect_both_components<5>();
}

}  // namespace
}  // namespace groupoids_laws_space_tests
