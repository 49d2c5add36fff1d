// exp, log, Cayley and their differentials: against their definitions, near 0 and near pi.
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace lagroid;

namespace groupoids_group_maps_tests {
namespace {

template <class G> class GroupMaps : public ::testing::Test {
 protected:
  static constexpr int n = G::dimension;
  using Xi = Vector<double, n>;
  std::mt19937_64 generator{7};

  Xi random(double size) {
    std::normal_distribution<double> normal;
    Xi xi;
    for (int i = 0; i < n; ++i) xi(i) = normal(generator);
    return xi * (size / xi.norm());
  }

  // vee(tau(xi)^{-1} d/dt tau(xi + t eta)), by dual numbers.
  template <class F> static Matrix<double, n, n> trivialised(const F& tau, const Xi& xi) {
    Matrix<double, n, n> d;
    for (int i = 0; i < n; ++i) {
      Vector<Dual<double>, n> x = xi.template cast<Dual<double>>();
      x(i).derivative = 1;
      const auto g = tau(x);
      const auto value = g.unaryExpr([](const Dual<double>& c) { return c.value; }).eval();
      const auto slope = g.unaryExpr([](const Dual<double>& c) { return c.derivative; }).eval();
      d.col(i) = G::vee((G::inverse(value) * slope).eval());
    }
    return d;
  }
};

using Groups = ::testing::Types<SO2, SO3, SE2, SE3>;
TYPED_TEST_SUITE(GroupMaps, Groups);

// However small the displacement, where the arrow itself is linear in it to round-off.
TYPED_TEST(GroupMaps, ExtendedArrowsHaveTheDerivativesOfTau) {
  constexpr int directions = TypeParam::dimension;
  using S = SecondJet<double, directions>;
  const auto g = TypeParam::tau({}, this->random(1.0));
  for (const double size : {0.0, 1e-9, 1e-6, 0.1}) {
    const auto at = (size * this->random(1.0)).eval();
    Vector<S, directions> w;
    for (int i = 0; i < directions; ++i) w(i) = S::variable(at(i), i);
    const auto arrow = g.template cast<S>().eval();
    const auto extended = TypeParam::extend(arrow, w);
    const auto composed = (arrow * TypeParam::tau({}, w)).eval();
    for (int k = 0; k < extended.size(); ++k) {
      EXPECT_NEAR(extended(k).value, composed(k).value, 1e-15);
      for (int i = 0; i < directions; ++i) {
        EXPECT_NEAR(extended(k).gradient(i), composed(k).gradient(i), 1e-14) << size;
        for (int j = 0; j < directions; ++j)
          EXPECT_NEAR(extended(k).hessian(i, j), composed(k).hessian(i, j), 1e-13) << size;
      }
    }
  }
}

TYPED_TEST(GroupMaps, HatAndVeeAreInverse) {
  const auto xi = this->random(2.0);
  EXPECT_EQ(TypeParam::vee(TypeParam::hat(xi)), xi);
}

TYPED_TEST(GroupMaps, ExpIsTheMatrixExponential) {
  for (const double size : {1e-8, 0.1, 1.0, 2.5}) {
    const auto xi = this->random(size);
    using Mat = Matrix<long double, TypeParam::matrix_size, TypeParam::matrix_size>;
    const Mat x = TypeParam::hat(xi).template cast<long double>();
    Mat term = Mat::Identity();
    Mat sum = term;
    for (int k = 1; k < 60; ++k) {
      term = (term * x / static_cast<long double>(k)).eval();
      sum += term;
    }
    EXPECT_LT((TypeParam::exp(xi) - sum.template cast<double>()).cwiseAbs().maxCoeff(), 1e-14) << size;
  }
}

TYPED_TEST(GroupMaps, LogInvertsExp) {
  for (const double size : {0.0, 1e-15, 1e-12, 1e-8, 1e-4, 0.01, 1.0, 2.0, 3.0, 3.14}) {
    const auto xi = size == 0 ? decltype(this->random(1.0))::Zero().eval() : this->random(size);
    EXPECT_LT((TypeParam::log(TypeParam::exp(xi)) - xi).norm(), 1e-13 * size + 1e-300) << size;
  }
}

TYPED_TEST(GroupMaps, CayleyIsItsDefinitionAndInvertible) {
  for (const double size : {1e-12, 1e-3, 0.5, 2.0, 10.0}) {
    const auto xi = this->random(size);
    using Mat = Matrix<double, TypeParam::matrix_size, TypeParam::matrix_size>;
    const Mat half = 0.5 * TypeParam::hat(xi);
    const Mat g = (Mat::Identity() - half).inverse() * (Mat::Identity() + half);
    EXPECT_LT((TypeParam::cayley(xi) - g).cwiseAbs().maxCoeff(), 2e-15 * (1 + size));
    EXPECT_LT((TypeParam::cayley_inverse(g) - xi).norm(), 1e-13 * size * (1 + size));
  }
}

TYPED_TEST(GroupMaps, DifferentialsAreLeftTrivialised) {
  for (const double size : {1e-9, 1e-3, 0.3, 1.7, 3.0}) {
    const auto xi = this->random(size);
    const auto dexp = TypeParam::dexp(xi);
    const auto dcay = TypeParam::dcayley(xi);
    EXPECT_LT((dexp - this->trivialised([](const auto& x) { return TypeParam::exp(x); }, xi)).norm(), 1e-13);
    EXPECT_LT((dcay - this->trivialised([](const auto& x) { return TypeParam::cayley(x); }, xi)).norm(), 1e-13);
    const auto one = dexp.Identity();
    EXPECT_LT((dexp * TypeParam::dexp_inverse(xi) - one).norm(), 1e-12);
    EXPECT_LT((dcay * TypeParam::dcayley_inverse(xi) - one).norm(), 1e-12 * (1 + size * size));
  }
}

TYPED_TEST(GroupMaps, AdIsTheCommutator) {
  const auto xi = this->random(1.3);
  const auto eta = this->random(0.8);
  const auto x = TypeParam::hat(xi);
  const auto y = TypeParam::hat(eta);
  if constexpr (TypeParam::dimension > 1) {
    EXPECT_LT((TypeParam::ad(xi) * eta - TypeParam::vee((x * y - y * x).eval())).norm(), 1e-14);
  } else {
    EXPECT_EQ((TypeParam::ad(xi) * eta).norm(), 0);
    EXPECT_EQ((x * y - y * x).norm(), 0);
  }
}

TYPED_TEST(GroupMaps, ProjectRepairsSmallDefects) {
  auto g = TypeParam::exp(this->random(1.0));
  const auto exact = g;
  g.template topLeftCorner<2, 2>() *= 1 + 1e-9;
  const auto repaired = TypeParam::project(g);
  const auto r = repaired.template topLeftCorner<2, 2>().eval();
  EXPECT_LT((repaired - exact).norm(), 1e-8);
  EXPECT_LT((TypeParam::inverse(repaired) * repaired - exact.Identity()).norm(), 1e-14);
  EXPECT_TRUE(r.allFinite());
}

TEST(InvariantFields, OnAGroupAreTheTranslationsOfTheAlgebra) {
  // [G] 6.1: X<-(g) = g hat(x), X->(g) = hat(x) g.
  const SO3 groupoid;
  const Matrix<double, 3, 3> g = SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9));
  const Vector<double, 3> x(0.3, 0.5, -0.7);
  EXPECT_LT((groupoid.left_invariant(g, x) - (g * SO3::hat(x)).reshaped()).norm(), 1e-15);
  EXPECT_LT((groupoid.right_invariant(g, x) - (SO3::hat(x) * g).reshaped()).norm(), 1e-15);
}

TEST(SO3Log, IsAccurateUpToPi) {
  const Vector<double, 3> axis = Vector<double, 3>(0.3, -0.5, 0.8).normalized();
  for (const double gap : {1e-1, 1e-4, 1e-8, 1e-12}) {
    const Vector<double, 3> w = axis * (std::numbers::pi - gap);
    EXPECT_LT((SO3::log(SO3::exp(w)) - w).norm(), 1e-14) << gap;
  }
  // At pi exactly the axis is found up to sign.
  Matrix<double, 3, 3> half_turn = 2 * axis * axis.transpose() - Matrix<double, 3, 3>::Identity();
  const auto w = SO3::log(half_turn);
  EXPECT_NEAR(w.norm(), std::numbers::pi, 1e-14);
  EXPECT_NEAR(std::abs(w.dot(axis)), std::numbers::pi, 1e-14);
}

TEST(SO3Log, NaiveFormulaFailsNearPiWhereOursDoesNot) {
  const Vector<double, 3> w = Vector<double, 3>(1, 2, -2) / 3 * (std::numbers::pi - 1e-7);
  const auto g = SO3::exp(w);
  const double angle = std::acos((g.trace() - 1) / 2);
  const Vector<double, 3> naive = SO3::vee(g) * (angle / std::sin(angle));
  EXPECT_GT((naive - w).norm(), 1e-10);
  EXPECT_LT((SO3::log(g) - w).norm(), 1e-14);
}

TEST(SE2Log, IsFiniteAtTinyAngles) {
  for (const double angle : {0.0, 1e-300, 1e-16, 1e-8}) {
    const Vector<double, 3> xi(angle, 1, 2);
    EXPECT_LT((SE2::log(SE2::exp(xi)) - xi).norm(), 1e-15);
  }
}

TEST(SO3, QuaternionsRoundTrip) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    Vector<double, 4> q(normal(generator), normal(generator), normal(generator), normal(generator));
    q.normalize();
    if (q(0) < 0) q = -q;
    EXPECT_LT((SO3::quaternion(SO3::from_quaternion(q)) - q).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace groupoids_group_maps_tests
