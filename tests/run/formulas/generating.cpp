// Hamiltonians that are texts: their steps are those of the same generating functions in C++, and types agree.
#include <lagroid/run/formula/formula_hamiltonian.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include "../../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace lagroid;

namespace formulas_generating_tests {
namespace {

struct Swing {
  static constexpr int dimension = 1, constraints = 0;
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::cos;
    return p(0) * p(0) * (0.5 + q(0) * q(0) * 0.1) - cos(q(0));
  }
};
FormulaHamiltonian swing(const TaylorChoice& taylor) {
  return {{.coordinates = {"q"}}, {"p"}, "p^2*(0.5 + 0.1*q^2) - cos(q)", taylor};
}
struct Bob {
  static constexpr int dimension = 3, constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return (p(0) * p(0) + p(1) * p(1) + p(2) * p(2)) * 0.5 + q(2);
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q(0) * q(0) + q(1) * q(1) + q(2) * q(2) - 1.0) * 0.5);
  }
};
FormulaHamiltonian bob(const TaylorChoice& taylor) {
  return {{.coordinates = {"x", "y", "z"}, .constraints = {"(x^2 + y^2 + z^2 - 1)/2"}},
          {},
          "(p_x^2 + p_y^2 + p_z^2)/2 + z",
          taylor};
}

/// Steps of both kinds from a start, which are to be one.
template <int R, class M, int N, int D>
void expect_the_map(const FormulaHamiltonian& formula, const M& system, const QuadratureRule& rule,
                    const Phase<N, D>& start, double h, int steps) {
  const TaylorHamiltonian<M, R> two{system, rule};
  const HamiltonianMap by_two(two);
  const HamiltonianMap by_three(adjoint_of(two));
  for (const GeneratingType type : {GeneratingType::two, GeneratingType::three}) {
    GeneratingStep step(formula, type);
    SizedState by_text{start.q, start.p};
    Phase<N, D> z = start;
    for (int k = 0; k < steps; ++k) {
      ASSERT_EQ(step.take(by_text, 0, h).status, SolveStatus::converged) << k;
      ASSERT_EQ(type == GeneratingType::two ? by_two.step(z, h) : by_three.step(z, h), SolveStatus::converged) << k;
    }
    EXPECT_LT((by_text.position - z.q).norm(), 1e-12) << R;
    EXPECT_LT((by_text.momentum - z.p).norm(), 1e-12) << R;
  }
}

TEST(FormulaHamiltonians, StepsAreThoseOfTheSameGeneratingFunctionsInCpp) {
  const Phase<1, 0> start{Vector<double, 1>(0.8), Vector<double, 1>(0.5)};
  expect_the_map<0>(swing({0, quadrature_rules::rectangle}), Swing{}, quadrature_rules::rectangle, start, 0.1, 20);
  expect_the_map<1>(swing({1, quadrature_rules::trapezoid}), Swing{}, quadrature_rules::trapezoid, start, 0.1, 20);
  expect_the_map<2>(swing({2, quadrature_rules::simpson}), Swing{}, quadrature_rules::simpson, start, 0.1, 20);
}
TEST(FormulaHamiltonians, WithConstraints) {
  const Phase<3, 1> start{{0.6, 0, -0.8}, {0, 0.7, 0}};
  expect_the_map<1>(bob({1, quadrature_rules::trapezoid}), Bob{}, quadrature_rules::trapezoid, start, 0.05, 20);
}

/// With the time as a coordinate whose momentum is energy: H(q, t, p) + p_t, which does not depend on time.
struct Driven {
  static constexpr int dimension = 2, constraints = 0;
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    using std::cos;
    return p(0) * p(0) * (0.5 + q(0) * q(0) * 0.1) - cos(q(0)) - q(0) * cos(q(1) * 1.3) * 0.4 + p(1);
  }
};
template <int R> double away_from_time_as_a_coordinate(const QuadratureRule& rule, double lag = 0) {
  const FormulaHamiltonian formula({.coordinates = {"q"}}, {"p"}, "p^2*(0.5 + 0.1*q^2) - cos(q) - 0.4*q*cos(1.3*t)",
                                   {R, rule});
  EXPECT_FALSE(formula.keeps_energy());
  const TaylorHamiltonian<Driven, R> two{Driven{}, rule};
  const double h = 0.1;
  double worst = 0;
  for (const GeneratingType type : {GeneratingType::two, GeneratingType::three}) {
    GeneratingStep step(formula, type);
    SizedState by_text{Eigen::VectorXd::Constant(1, 0.8), Eigen::VectorXd::Constant(1, 0.5)};
    Phase<2, 0> z{{0.8, 0.7}, {0.5, 0}};
    for (int k = 0; k < 20; ++k) {
      EXPECT_EQ(step.take(by_text, z.q(1) + lag, h).status, SolveStatus::converged);
      EXPECT_EQ(
          type == GeneratingType::two ? HamiltonianMap(two).step(z, h) : HamiltonianMap(adjoint_of(two)).step(z, h),
          SolveStatus::converged);
      worst = std::max({worst, std::abs(by_text.position(0) - z.q(0)), std::abs(by_text.momentum(0) - z.p(0))});
    }
  }
  return worst;
}
TEST(FormulaHamiltonians, OfTheTimeAreThoseWithTimeAsACoordinate) {
  EXPECT_LT(away_from_time_as_a_coordinate<0>(quadrature_rules::rectangle), 1e-12);
  EXPECT_LT(away_from_time_as_a_coordinate<1>(quadrature_rules::trapezoid), 1e-12);
  EXPECT_LT(away_from_time_as_a_coordinate<2>(quadrature_rules::gauss_2), 1e-12);
  EXPECT_GT(away_from_time_as_a_coordinate<1>(quadrature_rules::trapezoid, 0.1), 1e-4) << "a late clock is seen";
}

// From where everything is zero but a momentum: the rounding of an equation is that of what the step adds to it.
TEST(FormulaHamiltonians, LeaveTheOrigin) {
  const FormulaHamiltonian system({.coordinates = {"q"}}, {"p"}, "p^2/2 - cos(q)", {1, quadrature_rules::trapezoid});
  for (const GeneratingType type : {GeneratingType::two, GeneratingType::three})
    for (const double h : {0.1, 0.01, 0.001}) {
      GeneratingStep step(system, type);
      SizedState z{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
      EXPECT_EQ(step.take(z, 0, h).status, SolveStatus::converged) << h;
      EXPECT_NEAR(z.position(0), h, h * h);
    }
}

// A step of type III back undoes one of type II, and the product of both is symmetric.
TEST(FormulaHamiltonians, TypesAreEachOthersAdjoints) {
  const FormulaHamiltonian system = swing({3, quadrature_rules::gauss_2});
  GeneratingStep two(system, GeneratingType::two), three(system, GeneratingType::three);
  SymmetrisedGeneratingStep both(system);
  const Eigen::VectorXd q0 = Eigen::VectorXd::Constant(1, 0.8), p0 = Eigen::VectorXd::Constant(1, 0.5);
  SizedState z{q0, p0};
  ASSERT_TRUE(two.take(z, 0, 0.3).converged());
  ASSERT_TRUE(three.take(z, 0, -0.3).converged());
  EXPECT_LT((z.position - q0).norm() + (z.momentum - p0).norm(), 1e-14);
  ASSERT_TRUE(both.take(z, 0, 0.3).converged());
  ASSERT_TRUE(both.take(z, 0, -0.3).converged());
  EXPECT_LT((z.position - q0).norm() + (z.momentum - p0).norm(), 1e-14);
}

TEST(FormulaHamiltonians, TakeEveryFunctionThatFormulasHave) {
  const Vector<double, 1> q0(0.4), p0(0.3);
  for (const std::string f :
       {"sin(q)",  "cos(q)",  "tan(q)",   "asin(q)",      "acos(q)",         "atan(q)",   "sinh(q)",
        "cosh(q)", "tanh(q)", "asinh(q)", "acosh(1 + q)", "atanh(q)",        "exp(q)",    "ln(q)",
        "sqrt(q)", "abs(q)",  "q^2.5",    "2^q",          "atan2(q, 1 + q)", "1/(1 + q)", "-q"}) {
    const FormulaHamiltonian system({.coordinates = {"q"}}, {"p"}, "p^2/2 + 0.1*(" + f + ")",
                                    {3, quadrature_rules::gauss_2});
    SymmetrisedGeneratingStep step(system);
    std::vector<double> h(1 + 2 + 3);
    const auto energy = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& p) {
      system.hamiltonian(0, q.data(), p.data(), h.data());
      return h[0];
    };
    SizedState z{q0, p0};
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(step.take(z, 0, 0.05).converged()) << f;
    // Of order four: the coefficients of the flow are right.
    EXPECT_NEAR(energy(z.position, z.momentum), energy(q0, p0), 1e-8) << f;
    EXPECT_GT((z.position - q0).norm(), 0.01);
  }
}

// Nothing of the step's equations is of the size of a momentum then.
TEST(FormulaHamiltonians, BeginAtRest) {
  for (int taylor = 0; taylor <= 4; ++taylor) {
    const FormulaHamiltonian system = bob({taylor, quadrature_rules::gauss_3});
    for (const GeneratingType type : {GeneratingType::two, GeneratingType::three}) {
      GeneratingStep step(system, type);
      SizedState z{Eigen::Vector3d(0.6, 0, -0.8), Eigen::Vector3d(0, 0, 0)};
      for (int k = 0; k < 3; ++k) EXPECT_EQ(step.take(z, 0, 0.05).status, SolveStatus::converged) << taylor;
      EXPECT_NEAR(z.position.norm(), 1, 1e-14);
    }
  }
}

TEST(FormulaHamiltonians, StepsAllocateNothing) {
  const FormulaHamiltonian system = bob({3, quadrature_rules::gauss_2});
  SymmetrisedGeneratingStep step(system);
  SizedState z{Eigen::Vector3d(0.6, 0, -0.8), Eigen::Vector3d(0, 0.7, 0)};
  for (int k = 0; k < 3; ++k) step.take(z, 0, 0.05);
  const long before = allocation_count();
  if (before < 0) GTEST_SKIP() << "allocations are not counted here";
  for (int k = 0; k < 50; ++k) step.take(z, 0, 0.05);
  EXPECT_EQ(allocation_count(), before);
}

// Units do not decide whether equations are regular.
TEST(FormulaHamiltonians, OfAPlanetAndOfAMolecule) {
  for (const double mass : {1e-27, 1.0, 1e24}) {
    const FormulaHamiltonian system({.coordinates = {"x"}, .parameters = {{"m", mass}}}, {"p"}, "p^2/(2*m) + m*x^2/2",
                                    {3, quadrature_rules::gauss_2});
    for (const GeneratingType type : {GeneratingType::two, GeneratingType::three}) {
      SizedState one{Eigen::VectorXd::Constant(1, 1.0), Eigen::VectorXd::Zero(1)};
      EXPECT_EQ(GeneratingStep(system, type).take(one, 0, 0.1).status, SolveStatus::converged) << mass;
    }
    SymmetrisedGeneratingStep step(system);
    SizedState z{Eigen::VectorXd::Constant(1, 1.0), Eigen::VectorXd::Zero(1)};
    for (int k = 0; k < 10; ++k) ASSERT_EQ(step.take(z, 0, 0.1).status, SolveStatus::converged) << mass;
    EXPECT_NEAR(z.position(0), std::cos(1), 1e-5) << mass;
    EXPECT_NEAR(z.momentum(0) / mass, -std::sin(1), 1e-5) << mass;
  }
}

TEST(FormulaHamiltonians, SayWhatIsWrongWithTheirTexts) {
  const auto key_of = [](const FormulaTexts& texts, const std::vector<std::string>& momenta, const std::string& text) {
    try {
      const FormulaHamiltonian read(texts, momenta, text, {});
    } catch (const FormulaError& error) {
      return error.key();
    }
    return std::string();
  };
  EXPECT_EQ(key_of({.coordinates = {"q"}}, {}, "p_q^2"), "");
  EXPECT_EQ(key_of({.coordinates = {"q"}}, {"q"}, "q^2"), "momenta");
  EXPECT_EQ(key_of({.coordinates = {"q"}}, {"p", "r"}, "p^2"), "momenta");
  EXPECT_EQ(key_of({.coordinates = {"q"}}, {"p"}, "q'^2"), "H");
  EXPECT_EQ(key_of({.coordinates = {"q"}, .parameters = {{"n", 4.0}}}, {"p"}, "p^2 + q^n"), "H");
}

}  // namespace
}  // namespace formulas_generating_tests
