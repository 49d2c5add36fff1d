// Exact generating functions, and what approximates them.
#include "examples.hpp"

#include <lagroid/solvers/generating/chord_lagrangian.hpp>
#include <lagroid/solvers/generating/exact_generating_function.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lagroid::hamiltonian_map_tests::exact_tests {
namespace {

using enum GeneratingType;

/// The defects of the relations (2.8), (3.11) and (3.13) along a variation (dq, dp) of the start.
template <class M, int N>
std::vector<double> exact_defects(const M& system, const Vector<double, N>& q, const Vector<double, N>& p,
                                  const Vector<double, N>& dq, const Vector<double, N>& dp) {
  using D = Dual<double>;
  Vector<D, N> qs;
  Vector<D, N> ps;
  for (int i = 0; i < N; ++i) {
    qs(i) = D(q(i), dq(i));
    ps(i) = D(p(i), dp(i));
  }
  const auto arc = exact_arc(system, qs, ps, 1.3);
  const auto value = [](const auto& v) {
    return v.unaryExpr([](const D& x) { return x.value; }).template cast<double>().eval();
  };
  const auto pair = [&](const auto& a, const auto& b) { return value(a).dot(derivative_of(b)); };
  const double d1 = arc.generating(one).derivative;
  const double d2 = arc.generating(two).derivative;
  const double d3 = arc.generating(three).derivative;
  return {std::abs(d1 - (pair(arc.p1, arc.q1) - pair(arc.p0, arc.q0))),
          std::abs(d2 - (pair(arc.p0, arc.q0) + pair(arc.q1, arc.p1))),
          std::abs(d3 - (-pair(arc.p1, arc.q1) - pair(arc.q0, arc.p0)))};
}

TEST(ExactGeneratingFunctions, HaveTheFlowForTheirDerivatives) {
  const Vector<double, 3> dq(std::cos(1.0), 0.8, -std::sin(1.0));  // tangent to the sphere
  Vector<double, 3> dp(0.3, -0.5, 0.2);
  dp -= (dp.dot(bob_start.q) + bob_start.p.dot(dq)) * bob_start.q;  // q.p = 0 to first order
  for (const double defect : exact_defects(Bob{}, bob_start.q, bob_start.p, dq, dp)) EXPECT_LT(defect, 1e-13);
  // A variation that leaves the sphere is none of T*Q.
  for (const double defect :
       exact_defects(Bob{}, bob_start.q, bob_start.p, Vector<double, 3>(dq + 0.1 * bob_start.q), dp))
    EXPECT_GT(defect, 1e-3);

  const Vector<double, 1> q(0.4);
  const Vector<double, 1> p(0.9);
  for (const double defect : exact_defects(Swing{}, q, p, Vector<double, 1>(0.3), Vector<double, 1>(-0.8)))
    EXPECT_LT(defect, 1e-13);
}

TEST(ExactGeneratingFunctions, ArcsKeepEnergyAndConstraints) {
  const auto arc = exact_arc(Bob{}, bob_start.q, bob_start.p, 5.0);
  EXPECT_NEAR(Bob{}.hamiltonian(arc.q1, arc.p1), Bob{}.hamiltonian(arc.q0, arc.p0), 1e-13);
  EXPECT_LT(std::abs(Bob{}.constraint(arc.q1)(0)), 1e-13);
  EXPECT_LT(std::abs(arc.q1.dot(arc.p1)), 1e-13);
  const auto back = exact_arc(Bob{}, arc.q1, arc.p1, -5.0);
  EXPECT_LT((back.q1 - bob_start.q).norm() + (back.p1 - bob_start.p).norm(), 1e-12);
}

/// The exponent of h in |H_d+ - H_d^{+,E}| along the solution from a point.
template <class F> double approximation_order(const F& f, const typename HamiltonianMap<F>::Point& start, double h) {
  const auto error = [&](double step) {
    const auto arc = exact_arc(f.system, start.q, start.p, step);
    return std::abs(f.generating(arc.q0, arc.p1, step) - arc.generating(two));
  };
  return std::log2(error(h) / error(h / 2));
}

TEST(ExactGeneratingFunctions, AreApproximatedToTheOrderOfTheMap) {  // (4.4)
  const Phase<1, 0> start{Vector<double, 1>(0.4), Vector<double, 1>(0.9)};
  using quadrature_rules::gauss_3;
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 0>{{}, gauss_3}, start, 0.02), 2, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 1>{{}, gauss_3}, start, 0.02), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 2>{{}, gauss_3}, start, 0.04), 4, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 3>{{}, gauss_3}, start, 0.08), 5, 0.15);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 4>{{}, gauss_3}, start, 0.1), 6, 0.2);
}

TEST(ExactGeneratingFunctions, OfTheConstrainedAreMissedByTheCubeOfTheStep) {  // (4.20) holds for order two and no more
  using quadrature_rules::gauss_2;
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 1>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 2>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 3>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
}

/// No force, on the unit circle.
struct Circle {
  static constexpr int dimension = 2;
  static constexpr int constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 2>&, const Vector<S, 2>& p) const { return p.squaredNorm() * 0.5; }
  template <class S> S lagrangian(const Vector<S, 2>&, const Vector<S, 2>& v) const { return v.squaredNorm() * 0.5; }
  template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};

TEST(ExactGeneratingFunctions, OfChordAndArcDifferByTheCubeOfTheStep) {  // (4.12) likewise
  // (2 sin(v h / 2))^2 / (2 h) - v^2 h / 2 = -v^4 h^3 / 24 + ..., though without the circle the chord is exact.
  const double v = 1.3;
  for (const double h : {0.1, 0.05, 0.025}) {
    const auto arc = exact_arc(Circle{}, Vector<double, Circle::dimension>(1, 0), Vector<double, 2>(0, v), h);
    const double chord = ChordLagrangian<Circle>{{}}.generating(arc.q0, arc.q1, h);
    EXPECT_NEAR((chord - arc.generating(one)) / std::pow(h, 3), -std::pow(v, 4) / 24, 0.2 * h * h);
  }
}

}  // namespace
}  // namespace lagroid::hamiltonian_map_tests::exact_tests
