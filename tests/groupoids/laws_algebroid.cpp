// Lie algebroids: brackets, anchors and bisections of every groupoid of the library; wrong ones fail.
#include <lagroid/core/testing/algebroid_laws.hpp>
#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/time_extended.hpp>
#include <lagroid/groupoids/trivial.hpp>

#include "../support/affine.hpp"
#include "../support/broken.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_algebroid_tests {
namespace {

template <class G> class AlgebroidLaws : public testing::Test {};
using Groupoids =
    testing::Types<Affine, VectorGroup<2>, Pair<2>, SO2, SE2, SO3, SpecialOrthogonal3<Retraction::cayley>, SE3,
                   Orthogonal<4>, Trivial<2, SO3>, TimeExtended<Pair<1>>, Action<SO3, RotatedVectors>>;
TYPED_TEST_SUITE(AlgebroidLaws, Groupoids);

TYPED_TEST(AlgebroidLaws, Hold) {
  const auto report = laws::algebroid_laws<TypeParam>({}, moderate());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(AlgebroidLawsOnTheSphere, Hold) {
  const auto direction = [] {
    return Vector<double, 3>((laws::draw_vector<3>(1.0) + Vector<double, 3>(1e-3, 2e-3, 1e-3)).normalized());
  };
  const auto report = laws::algebroid_laws(Action<SO3, RotatedDirections>{}, direction, moderate());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(Bracket, OfRotationsIsTheCrossProduct) {
  const Eigen::Vector3d x(1, 2, 3);
  const Eigen::Vector3d y(-2, 0.5, 1);
  const SO3 rotations;
  const LieAlgebroid<SO3> algebroid(rotations);
  EXPECT_LT((algebroid.automatic_frame_bracket(Vector<double, 0>(), x, y) - x.cross(y)).norm(), 1e-14);
}

TEST(Bracket, OfVectorFieldsOnThePlane) {
  // [x d/dy, y d/dx] = x d/dx - y d/dy on TR^2.
  const Pair<2> plane;
  const LieAlgebroid<Pair<2>> algebroid(plane);
  const auto first = [](const auto& q) { return std::decay_t<decltype(q)>(q(0) * 0.0, q(0)); };
  const auto second = [](const auto& q) { return std::decay_t<decltype(q)>(q(1), q(0) * 0.0); };
  const Eigen::Vector2d q(0.3, -0.7);
  EXPECT_LT((algebroid.bracket(q, first, second) - Eigen::Vector2d(0.3, 0.7)).norm(), 1e-15);
  EXPECT_LT((algebroid.fields_bracket(q, first, second) - Eigen::Vector2d(0.3, 0.7)).norm(), 1e-15);
}

TEST(StructureFunctions, OfTheAffineGroup) {
  // [e_1, e_2] = -e_2 at every object.
  const Affine groupoid;
  const auto c = LieAlgebroid<Affine>(groupoid).structure_functions(Vector<double, 1>(0.4));
  EXPECT_EQ(c[0], (Matrix<double, 2, 2>::Zero()));
  EXPECT_EQ(c[1](0, 1), -1);
  EXPECT_EQ(c[1](1, 0), 1);
}

/// A diffeomorphism of the line as a bisection of its pair groupoid.
struct Wave {
  template <class S> PairArrow<S, 1> operator()(const Vector<S, 1>& q) const {
    using std::sin;
    return {q, Vector<S, 1>(q(0) + sin(q(0)) * 0.5)};
  }
};
TEST(Bisection, OfAPairIsADiffeomorphismOfTheObjects) {
  const Bisection wave(Pair<1>{}, Vector<double, 1>(0.0), Wave{});
  const Vector<double, 1> q(0.4);
  EXPECT_EQ((wave * wave)(q).target, wave.image(wave.image(q)));
  EXPECT_NEAR(wave.inverse().image(wave.image(q))(0), 0.4, 1e-15);
  // Derivatives of the inverse: 1 / f' and -f'' / f'^3.
  using D = Dual<Dual<double>>;
  const Vector<D, 1> r(D(Dual<double>(wave.image(q)(0), 1.0), Dual<double>(1.0)));
  const D p = wave.preimage(r)(0);
  const double slope = 1 + 0.5 * std::cos(0.4);
  EXPECT_NEAR(p.value.derivative, 1 / slope, 1e-15);
  EXPECT_NEAR(p.derivative.derivative, 0.5 * std::sin(0.4) / (slope * slope * slope), 1e-15);
}
TEST(Bisection, SaysWhereItHasNoArrow) {
  const Bisection bounded(Pair<1>{}, Vector<double, 1>(0.0), [](const auto& q) {
    using std::tanh;
    return std::decay_t<decltype(Pair<1>::unit(q))>{q, q.unaryExpr([](const auto& x) { return tanh(x); })};
  });
  EXPECT_THROW(bounded.preimage(Vector<double, 1>(2.0)), OutsideBisection);
}

void expect_broken(Fault fault, const std::vector<std::string>& names) {
  Affine groupoid;
  groupoid.fault = fault;
  const auto report = laws::algebroid_laws(groupoid, moderate());
  for (const auto& law : names) EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

TEST(BrokenAlgebroid, BracketOfTheWrongSign) {
  expect_broken(Fault::bracket, {"bracket is that of left-invariant fields",
                                 "bracket is minus that of right-invariant fields", "anchor is a homomorphism"});
}
TEST(BrokenAlgebroid, TransposedAnchor) {
  expect_broken(Fault::anchor, {"Leibniz rule with the anchor", "anchor is a homomorphism"});
}
TEST(BrokenAlgebroid, BisectionThatMissesItsArrow) {
  expect_broken(Fault::bisection,
                {"bisections", "products of bisections", "inverses of bisections", "translations by bisections"});
}
TEST(BrokenAlgebroid, ChartThatIsNotInverted) { expect_broken(Fault::object_chart, {"chart of the objects"}); }

/// A frame bracket that is antisymmetric but no Lie bracket, and one that is not even that.
template <bool Antisymmetric> struct NotLie : VectorGroup<3> {
  template <class S> static Vector<S, 3> bracket(const Vector<S, 0>&, const Vector<S, 3>& x, const Vector<S, 3>& y) {
    const S b = x(0) * y(1) - (Antisymmetric ? x(1) * y(0) : S(0.0));
    return {b, x(1) * y(2) - x(2) * y(1), b};
  }
};
TEST(BrokenAlgebroid, NotLie) {
  const auto twisted = laws::algebroid_laws<NotLie<true>>();
  EXPECT_TRUE(twisted.law("bracket is antisymmetric").holds()) << twisted;
  EXPECT_TRUE(laws::seen_broken(twisted.law("Jacobi identity"))) << twisted;
  EXPECT_TRUE(laws::seen_broken(laws::algebroid_laws<NotLie<false>>().law("bracket is antisymmetric")));
}

/// A bracket that is not linear.
struct NotLinear : VectorGroup<2> {
  template <class S> static Vector<S, 2> bracket(const Vector<S, 0>&, const Vector<S, 2>& x, const Vector<S, 2>& y) {
    return x.squaredNorm() * y - y.squaredNorm() * x;
  }
};
TEST(BrokenAlgebroid, NotLinear) {
  EXPECT_TRUE(laws::seen_broken(laws::algebroid_laws<NotLinear>().law("bracket is bilinear")));
}

}  // namespace
}  // namespace groupoids_laws_algebroid_tests
