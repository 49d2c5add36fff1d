// HyperDual and dual numbers, and the functions the group maps are made of.
#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/core/scalars/hyper_dual.hpp>
#include <lagroid/core/scalars/jet.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace lagroid;

namespace core_scalars_tests {
namespace {

using M = HyperDual<double, 2, 3>;
using J = Jet<double, 5>;
using D = Dual<Dual<double>>;

// Seeds two variables with all infinitesimals of both kinds.
struct Seeds {
  double x, y;
  Vector<double, 2> xl{0.7, -0.3}, yl{0.2, 1.1};
  Vector<double, 3> xr{0.5, 0.4, -0.9}, yr{-0.6, 0.8, 0.1};
  static M seeded(double value, const Vector<double, 2>& left, const Vector<double, 3>& right) {
    M s(value);
    for (int i = 0; i < 2; ++i) s.set_left(i, left(i));
    for (int j = 0; j < 3; ++j) s.set_right(j, right(j));
    return s;
  }
  M mx() const { return seeded(x, xl, xr); }
  M my() const { return seeded(y, yl, yr); }
  static J together(double value, const Vector<double, 2>& left, const Vector<double, 3>& right) {
    J s(value);
    for (int i = 0; i < 2; ++i) s.set_left(i, left(i));
    for (int j = 0; j < 3; ++j) s.set_right(2 + j, right(j));
    return s;
  }
  D dx(int i, int j) const { return {{x, xr(j)}, {xl(i), 0.0}}; }
  D dy(int i, int j) const { return {{y, yr(j)}, {yl(i), 0.0}}; }
};

// f on HyperDual and on Jet against f on nested dual numbers, entry by entry.
template <class F> void expect_agreement(const char* name, const F& f, double x, double y, double tolerance = 1e-12) {
  const Seeds s{x, y};
  const M m = f(s.mx(), s.my());
  const J jet = f(Seeds::together(x, s.xl, s.xr), Seeds::together(y, s.yl, s.yr));
  EXPECT_NEAR(jet.value, m.value, tolerance * (1 + std::abs(m.value))) << name;
  EXPECT_LT((jet.gradient().head<2>() - m.left()).norm(), tolerance * (1 + m.left().norm())) << name;
  EXPECT_LT((jet.gradient().tail<3>() - m.right()).norm(), tolerance * (1 + m.right().norm())) << name;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j) {
      const D d = f(s.dx(i, j), s.dy(i, j));
      EXPECT_NEAR(m.value, d.value.value, tolerance * (1 + std::abs(m.value))) << name;
      EXPECT_NEAR(m.left(i), d.derivative.value, tolerance * (1 + std::abs(m.left(i)))) << name;
      EXPECT_NEAR(m.right(j), d.value.derivative, tolerance * (1 + std::abs(m.right(j)))) << name;
      EXPECT_NEAR(m.mixed(i, j), d.derivative.derivative, tolerance * (1 + std::abs(m.mixed(i, j)))) << name;
    }
}

TEST(HyperDual, ArithmeticAgreesWithNestedDuals) {
  const auto f = [](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    S z = x * y + S(2) * x / y - y + S(3);
    z += x;
    z -= y * S(0.5);
    z *= x;
    z /= y;
    return -z;
  };
  expect_agreement("arithmetic", f, 1.3, -0.7);
}

TEST(HyperDual, ArithmeticWithPlainNumbers) {
  const Seeds s{0.8, 0.3};
  const M x = s.mx();
  const M a = 2.0 * x + 1.0 - x / 4.0 + 3.0 / x - (5.0 - x);
  const M b = M(2) * x + M(1) - x / M(4) + M(3) / x - (M(5) - x);
  EXPECT_NEAR(a.value, b.value, 1e-14);
  EXPECT_TRUE(a.left().isApprox(b.left(), 1e-14));
  EXPECT_TRUE(a.right().isApprox(b.right(), 1e-14));
  EXPECT_TRUE(a.mixed().isApprox(b.mixed(), 1e-13));
  EXPECT_EQ(M(3).left().norm(), 0);
  EXPECT_LT(M(1), M(2));
}

#define LAGROID_CHECK_FUNCTION(name, x0) \
  expect_agreement(                      \
      #name, [](const auto& a, const auto& b) { return name(a * b + a * a * 0.1); }, x0, 0.9)

TEST(HyperDual, FunctionsAgreeWithNestedDuals) {
  for (const double x : {0.1, 0.4, 0.75}) {
    LAGROID_CHECK_FUNCTION(sqrt, x);
    LAGROID_CHECK_FUNCTION(exp, x);
    LAGROID_CHECK_FUNCTION(log, x);
    LAGROID_CHECK_FUNCTION(sin, x);
    LAGROID_CHECK_FUNCTION(cos, x);
    LAGROID_CHECK_FUNCTION(tan, x);
    LAGROID_CHECK_FUNCTION(asin, x);
    LAGROID_CHECK_FUNCTION(acos, x);
    LAGROID_CHECK_FUNCTION(atan, x);
    LAGROID_CHECK_FUNCTION(sinh, x);
    LAGROID_CHECK_FUNCTION(cosh, x);
    LAGROID_CHECK_FUNCTION(tanh, x);
    LAGROID_CHECK_FUNCTION(abs, x);
    LAGROID_CHECK_FUNCTION(stumpff<0>, x);
    LAGROID_CHECK_FUNCTION(stumpff<1>, x);
    LAGROID_CHECK_FUNCTION(stumpff<2>, x);
    LAGROID_CHECK_FUNCTION(stumpff<3>, x);
    LAGROID_CHECK_FUNCTION(angle_ratio<0>, x);
    expect_agreement(
        "pow", [](const auto& a, const auto& b) { return pow(a * b, 2.5); }, x, 0.9);
  }
  for (const double x : {5.0, 30.0}) LAGROID_CHECK_FUNCTION(stumpff<3>, x);
}

TEST(HyperDual, Atan2InEveryQuadrant) {
  for (const double x : {-1.2, 0.4, 1.2})
    for (const double y : {-0.9, 0.3, 2.0})
      expect_agreement(
          "atan2", [](const auto& a, const auto& b) { return atan2(b, a); }, x, y);
  EXPECT_DOUBLE_EQ(atan2(M(1.0), M(-1.0)).value, std::atan2(1.0, -1.0));
}

TEST(SpecialFunctions, StumpffAgainstLongDoubleDefinitions) {
  for (const double a : {1e-12, 1e-8, 1e-4, 0.01, 0.3, 1.0, 1.99, 2.01, 3.0, 6.0, 20.0}) {
    const long double b = a;
    const double x = a * a;
    const long double c2 = 2 * std::sin(b / 2) * std::sin(b / 2) / (b * b);
    EXPECT_NEAR(stumpff<0>(x), double(std::cos(b)), 1e-15 * (1 + a));
    EXPECT_NEAR(stumpff<1>(x), double(std::sin(b) / b), 4e-16 * (1 + a / 4));
    EXPECT_NEAR(stumpff<2>(x) / double(c2), 1, 2e-15 * (1 + a));
    // (b - sin b)/b^3 cancels in long double too, below a = 0.01.
    if (a >= 0.01) {
      EXPECT_NEAR(stumpff<3>(x) / double((b - std::sin(b)) / (b * b * b)), 1, 2e-14);
    }
  }
  EXPECT_DOUBLE_EQ(stumpff<2>(0.0), 0.5);
  EXPECT_DOUBLE_EQ(stumpff<3>(0.0), 1.0 / 6);
}

TEST(SpecialFunctions, NaiveVersinLosesEverythingWhereStumpffDoesNot) {
  const double a = 1e-8;
  const double naive = (1 - std::cos(a)) / (a * a);
  EXPECT_GT(std::abs(naive - 0.5), 0.1);
  EXPECT_NEAR(stumpff<2>(a * a), 0.5, 1e-15);
}

TEST(SpecialFunctions, AngleRatioAndItsDerivatives) {
  for (const double half : {1e-9, 1e-5, 1e-2, 0.3, 0.44, 0.46, 1.0, 1.5}) {
    const double w = std::cos(half);
    EXPECT_NEAR(angle_ratio<0>(w), half < 1e-7 ? 2.0 : 2 * half / std::sin(half), 1e-14);
    const double e = 1e-5;
    if (w < 1 - 2 * e) {
      EXPECT_NEAR(angle_ratio<1>(w), (angle_ratio<0>(w + e) - angle_ratio<0>(w - e)) / (2 * e), 1e-8);
      EXPECT_NEAR(angle_ratio<2>(w), (angle_ratio<1>(w + e) - angle_ratio<1>(w - e)) / (2 * e), 1e-8);
      EXPECT_NEAR(angle_ratio<3>(w), (angle_ratio<2>(w + e) - angle_ratio<2>(w - e)) / (2 * e), 1e-7);
    }
  }
}

TEST(HyperDual, LongDoubleInstantiation) {
  using L = HyperDual<long double, 1, 1>;
  L x(0.5L);
  x.set_left(0, 1);
  x.set_right(0, 1);
  const L y = sin(x * x);
  EXPECT_NEAR(double(y.mixed(0, 0)), 2 * std::cos(0.25) - std::sin(0.25), 1e-15);
}

}  // namespace
}  // namespace core_scalars_tests
