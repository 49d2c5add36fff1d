// What Hamiltonian maps are made of: power series, implicit functions, the Legendre transform.
#include "examples.hpp"

#include <lagroid/core/hamiltonian/legendre_transform.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::hamiltonian_map_tests::derivatives_tests {
namespace {

// ---- power series

template <class F> double series_defect(const F& f, double x, double t) {
  // f(x + t + t^2 / 2) by its series, against its value.
  Series<double, 24> s(x);
  s[1] = 1;
  s[2] = 0.5;
  return std::abs(f(s).at(t) - f(x + t + t * t / 2));
}

TEST(PowerSeries, OfElementaryFunctionsSumToThem) {
  using std::exp, std::log, std::pow, std::sqrt;
  using std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh, std::cosh, std::tanh;
  const double t = 0.06;
  const auto defect = [&](const auto& f) { return series_defect(f, 0.4, t); };
  EXPECT_LT(defect([](auto x) { return sqrt(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return exp(x) / x; }), 2e-14);
  EXPECT_LT(defect([](auto x) { return log(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return pow(x, 1.7); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return pow(x, -3.0); }), 2e-14);
  EXPECT_LT(defect([](auto x) { return pow(x, 3.0); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return sin(x) * cos(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return tan(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return sinh(x) + cosh(x) - tanh(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return asin(x) - acos(x); }), 1e-14);
  EXPECT_LT(defect([](auto x) { return atan(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return 2.0 / (1.0 + x) - x * 3.0; }), 1e-15);
  // At zero, where x^p has derivatives for natural p only.
  EXPECT_LT(series_defect([](auto x) { return pow(x, 2.0); }, 0, t), 1e-16);
  // Twelve terms do not: the check can fail.
  Series<double, 12> few(0.4);
  few[1] = 1;
  few[2] = 0.5;
  EXPECT_GT(std::abs(sqrt(few).at(0.06) - sqrt(0.4 + 0.0618)), 1e-15);
}

TEST(PowerSeries, GiveTheTaylorCoefficientsOfAFlow) {
  // z' = z^2: z = 1 / (1 - t).
  const auto z = taylor_solution<10>([](const auto& x) { return x.cwiseProduct(x).eval(); }, Vector<double, 1>(1.0));
  for (int k = 0; k < 10; ++k) EXPECT_DOUBLE_EQ(z(0)[k], 1);
}

// ---- implicit equations and the continuous Legendre transform

TEST(ImplicitFunctions, HaveExactFirstAndSecondDerivatives) {
  // x = sqrt(y) by x^2 = y.
  using J = SecondJet<double, 1>;
  const auto square = [](const auto& x, const auto& y) { return (x.cwiseProduct(x) - y).eval(); };
  const double y = 2.7;
  const auto at = [&]<class S>(const S& value) {
    return solve_implicit<S, 1, 1>(square, Vector<double, 1>(1.0), Vector<S, 1>(value))(0);
  };
  const J x = at(J::variable(y, 0));
  EXPECT_NEAR(x.value, std::sqrt(y), 1e-15);
  EXPECT_NEAR(x.gradient(0), 0.5 / std::sqrt(y), 1e-15);
  EXPECT_NEAR(x.hessian(0, 0), -0.25 / (y * std::sqrt(y)), 1e-15);
  using D3 = Dual<Dual<Dual<double>>>;
  const D3 cubed = at(D3({{y, 1.0}, {1.0, 0.0}}, {{1.0, 0.0}, {0.0, 0.0}}));
  EXPECT_NEAR(cubed.derivative.derivative.derivative, 0.375 / (y * y * std::sqrt(y)), 1e-15);
  // From there Newton's method does not reach a root: there is none.
  EXPECT_TRUE(std::isnan(at(-1.0)));
}

/// A particle in a magnetic potential, with relativistic kinetic energy: hyperregular, far from quadratic.
struct Fast {
  template <class S> S lagrangian(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    using std::sqrt;
    return -sqrt(1.0 - v.squaredNorm()) + q(0) * v(1) * 0.3 - q(1) * q(0);
  }
};

TEST(ContinuousLegendreTransform, IsTheHamiltonianAndBackAgain) {
  const HamiltonianOf<Fast> fast;
  const Vector<double, 2> q(0.3, -0.4);
  const Vector<double, 2> p(1.9, -2.2);
  const auto exact = [](const auto& x, const auto& y) {
    using std::sqrt;
    const auto k = y(1) - x(0) * 0.3;
    return sqrt(1.0 + y(0) * y(0) + k * k) + x(1) * x(0);
  };
  using J = SecondJet<double, 4>;
  Vector<J, 2> qs;
  Vector<J, 2> ps;
  for (int i = 0; i < 2; ++i) {
    qs(i) = J::variable(q(i), i);
    ps(i) = J::variable(p(i), 2 + i);
  }
  const J found = fast.hamiltonian(qs, ps);
  const J expected = exact(qs, ps);
  EXPECT_NEAR(found.value, expected.value, 1e-14);
  EXPECT_LT((found.gradient() - expected.gradient()).norm(), 1e-13);
  EXPECT_LT((found.hessian() - expected.hessian()).norm(), 1e-12);

  const LagrangianOf<HamiltonianOf<Fast>> back;
  const Vector<double, 2> v(0.5, -0.6);
  EXPECT_NEAR(back.lagrangian(q, v), Fast{}.lagrangian(q, v), 1e-14);
  const Vector<double, 2> momentum =
      gradient_of([&](const auto& x) { return Fast{}.lagrangian(q.cast<Dual<double>>().eval(), x); }, v);
  EXPECT_LT((fast.velocity(q, momentum) - v).norm(), 1e-14);
}

}  // namespace
}  // namespace lagroid::hamiltonian_map_tests::derivatives_tests
