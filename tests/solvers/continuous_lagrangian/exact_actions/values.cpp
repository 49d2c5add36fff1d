// The exact discrete Lagrangian: its value, its step on R^n, and how the actions of rules differ from it.
#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/solvers/galerkin/testing/exact_action_laws.hpp>

#include "../subjects.hpp"
#include "exact_steps.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace exact_actions_values_tests {
namespace {

struct Oscillator : ContinuousLagrangian<Pair<1>> {
  template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
    return (v(0) * v(0) - q(0) * q(0)) * 0.5;
  }
};
TEST(ExactAction, IsThatOfTheSolution) {
  const double a = 0.7, b = -0.2;
  for (const double h : {0.01, 0.3, 1.0}) {
    const ExactLagrangian<Oscillator> exact{{}, h};
    // Feynman and Hibbs 1965, problem 2-2.
    const double action = ((a * a + b * b) * std::cos(h) - 2 * a * b) / (2 * std::sin(h));
    EXPECT_NEAR(exact.lagrangian(PairArrow<double, 1>{Vector<double, 1>(a), Vector<double, 1>(b)}) / action, 1, 1e-14)
        << h;
  }
}

TEST(ExactAction, StepsOfAPendulumAreItsFlow) {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  const auto force = [](const auto& q, const auto&, double) { return Vector<double, 1>(-std::sin(q(0))); };
  const State<Pair<1>> end = reference_motion(1.0, force, start, 8.0);
  expect_flow(ExactLagrangian<Swing>{}, start, Eigen::VectorXd(Eigen::Vector2d(end.object(0), end.momentum(0))), 8,
              {12, 20, 80});
}

// The action of a chord under a potential is known to third order: h^3 (U'' v^2 + U'^2) / 24 above the least.
TEST(ExactAction, TheFirstTermOfThePendulumsModifiedLagrangian) {
  const double q = 0.7, v = 1.2;
  const ExtrapolatedNumber found = modified_term(Midpoint<Swing>{}, Vector<double, 1>(q), Vector<double, 1>(v));
  EXPECT_NEAR(found.value, (std::cos(q) * v * v + std::sin(q) * std::sin(q)) / 24, 1e-9);
  EXPECT_LT(found.error, 1e-7);
  // The trapezoid has three times the curvature, of the other sign: U(q +- h v / 2) in the mean.
  const ExtrapolatedNumber ends = modified_term(Trapezoidal<Swing>{}, Vector<double, 1>(q), Vector<double, 1>(v));
  EXPECT_NEAR(ends.value, (-2 * std::cos(q) * v * v + std::sin(q) * std::sin(q)) / 24, 1e-9);
}
// Of order four there is a term in h^4, and none below.
TEST(ExactAction, RulesOfOrderFourHaveATermOfThatOrder) {
  const ExtrapolatedNumber found =
      modified_term(Galerkin<Oscillator, 2>{}, Vector<double, 1>(0.7), Vector<double, 1>(1.2), 0.4);
  EXPECT_GT(std::abs(found.value), 1e-5);
  EXPECT_LT(found.error, 1e-3 * std::abs(found.value));
}

State<Pair<1>> draw_swing() {
  return {Vector<double, 1>(laws::draw_uniform()), Vector<double, 1>(1.5 * laws::draw_uniform())};
}
/// Declares an order that it has not.
struct Boasting : Midpoint<Swing> {
  using Midpoint<Swing>::Midpoint;
  static MethodTraits traits() { return {"boasting", 3, true, true, false}; }
};
TEST(ExactAction, OrdersAreSeenInTheActionItself) {
  EXPECT_TRUE(laws::exact_action_laws(Midpoint<Swing>{}, draw_swing, 0.1).holds());
  EXPECT_TRUE(laws::exact_action_laws(Trapezoidal<Swing>{}, draw_swing, 0.1).holds());
  const laws::LawReport four = laws::exact_action_laws(Galerkin<Swing, 2>{}, draw_swing, 0.4);
  EXPECT_TRUE(four.holds()) << four;
  const laws::Sampling quiet(20, 1);
  const laws::LawReport boasting = laws::exact_action_laws(Boasting{}, draw_swing, 0.1);
  EXPECT_FALSE(boasting.law("the action is exact to the declared order").holds());
}

TEST(ExactAction, AStepThatBendsTooMuchIsRefused) {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  EXPECT_EQ(failed_step(ExactLagrangian<Swing>{{}, 6.0}, start), SolveStatus::not_finite);
  const ExactLagrangian<Swing> exact{{}, 6.0};
  EXPECT_FALSE(exact.unresolved({start.object, Vector<double, 1>(-1.0)}) < 1e-8);
}

}  // namespace
}  // namespace exact_actions_values_tests
