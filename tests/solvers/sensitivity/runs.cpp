// Derivatives of runs by composed steps and by steps that depend on time, of functions of nodes, and what is refused.

#include "../../support/allocation_counter.hpp"

#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <gtest/gtest.h>

namespace lagroid::sensitivity_runs_tests {
namespace {

/// A hard spring, U = k q^4 / 4 + c q^2 / 2, of which c carries no derivative.
struct HardSpring : MechanicalSystem<HardSpring, 1> {
  double stiffness = 1;
  double slope = 0.5;
  static auto parameters() {
    return std::tuple(parameter("stiffness", &HardSpring::stiffness, "N/m^3", "of the spring"),
                      parameter("slope", &HardSpring::slope, "N/m", "of the spring at rest"), quadrature_parameter());
  }
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const {
    const S square = q(0) * q(0);
    return square * square * (varied<S>(stiffness) * 0.25) + square * (0.5 * slope);
  }
};
using Line = State<Pair<1>>;
const Line start{Vector<double, 1>(1.2), Vector<double, 1>(0.3)};
const auto unit = Pair<1>::unit(start.object);
constexpr auto position = [](const auto& node) { return node.object(0); };

HardSpring spring() {
  HardSpring out;
  out.h = 0.1;
  return out;
}

std::unique_ptr<Integrator<HardSpring>> composed(const HardSpring& system, const Line& from) {
  return std::make_unique<detail::IntegratorOf<HardSpring, CompositionIntegrator<HardSpring>>>(
      system, from, Pair<1>::unit(from.object), compositions::suzuki,
      [] { return std::make_unique<NewtonStep<HardSpring>>(); });
}

TEST(RunGradients, StepsForwardTakeNoMemory) {
  const auto taken = [](long steps) {
    LinearisedMotionOf<HardSpring> motion(
        spring(), detail::newton_integrator(spring(), start, SensitivityOptions<HardSpring>{}), {"stiffness"},
        [](const ObservedNode<HardSpring>& node) { return VariedVector(node.momentum); });
    const long before = allocation_count();
    EXPECT_TRUE(propagate_forward(motion, steps, Eigen::MatrixXd::Identity(3, 3)).converged());
    return allocation_count() - before;
  };
  if (allocation_count() < 0) GTEST_SKIP() << "allocations cannot be counted here";
  EXPECT_EQ(taken(1100), taken(2000));  // of a few steps, the last at 1024, growth sees the matrix
}

TEST(RunGradients, ComposedStepsAreProductsOfTheirStages) {
  constexpr long steps = 20;
  const SensitivityOptions<HardSpring> options{.steps = steps, .parameters = {"stiffness"}};
  const Sensitivities found = sensitivities<HardSpring>(spring(), composed(spring(), start), options);
  ASSERT_TRUE(found.converged());
  EXPECT_NEAR(found.by_start.determinant(), 1, 1e-13);
  const auto end = [&](double by_position, double by_stiffness) {
    HardSpring system = spring();
    system.stiffness += by_stiffness;
    auto integrator = composed(system, {start.object + Vector<double, 1>(by_position), start.momentum});
    for (long k = 0; k < steps; ++k) integrator->advance();
    Eigen::VectorXd out(2);
    out << integrator->point().state.object, integrator->point().state.momentum;
    return out;
  };
  using laws::detail::extrapolated_difference;
  const auto by_position = extrapolated_difference([&](double x) { return end(x, 0); }, 4e-3);
  const auto by_stiffness = extrapolated_difference([&](double k) { return end(0, k); }, 4e-3);
  EXPECT_LE((found.by_start.col(0) - by_position).norm(), 1e-9 * by_position.norm());
  EXPECT_LE((found.by_parameters.col(0) - by_stiffness).norm(), 1e-9 * by_stiffness.norm());
}

/// A spring on a support that moves by a cos(nu t).
struct MovedSpring : System<MovedSpring, Pair<1>> {
  double h = 0.1;
  double time = 0;
  double frequency = 1.3;
  static auto parameters() {
    return std::tuple(parameter("frequency", &MovedSpring::frequency, "rad/s", "of the support"));
  }
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& at, const T& step) const {
    using std::cos;
    const S dq = g.target(0) - g.source(0);
    const S stretch = (g.target(0) + g.source(0)) * 0.5 - cos((at + step * 0.5) * varied<S>(frequency));
    return dq * dq * (0.5 / step) - stretch * stretch * stretch * stretch * (0.25 * step);
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, time, h); }
};
TEST(RunGradients, StepsThatDependOnTimeAreTakenWhereTheyAre) {
  MovedSpring moved;
  const auto report = laws::sensitivity_laws(
      moved,
      [] {
        return Line{Vector<double, 1>(laws::draw_uniform()), Vector<double, 1>(laws::draw_uniform())};
      },
      12);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(RunGradients, AreThoseOfFunctionsAtNodesAndOverTheRun) {
  const auto at = [&](const Observed& observed, long steps) {
    const RunGradient found =
        gradient(spring(), start, position, {.steps = steps, .parameters = {"stiffness"}, .observed = observed});
    EXPECT_TRUE(found.converged());
    Eigen::VectorXd out(4);
    out << found.values(0), found.by_start.transpose(), found.by_parameters(0, 0);
    return out;
  };
  // A node is the end of a shorter run, and the integral the sum of nodes.
  EXPECT_LE((at(Observed::at_node(3), 8) - at(Observed::at_end(), 3)).norm(), 1e-14);
  EXPECT_EQ(at(Observed::at_node(0), 8), Eigen::Vector4d(1.2, 1, 0, 0));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(4);
  for (long k = 0; k <= 8; ++k) sum += (k == 0 || k == 8 ? 0.05 : 0.1) * at(Observed::at_node(k), 8);
  EXPECT_LE((at(Observed::integral(), 8) - sum).norm(), 1e-14);
  EXPECT_THROW(at(Observed::at_node(9), 8), std::invalid_argument);
}

TEST(RunGradients, KeepTheirBudgetOfStates) {
  constexpr long steps = 1000;
  const auto of = [&](StateBudget budget) {
    return gradient(spring(), start, position, {.steps = steps, .parameters = {"stiffness"}, .budget = budget});
  };
  const RunGradient most = of({});
  EXPECT_LE(most.states_kept, 64);  // 2 sqrt(N)
  EXPECT_LE(most.steps_solved, 3 * steps);
  const RunGradient few = of(StateBudget::logarithmic(steps));
  EXPECT_LE(few.states_kept, 20);
  EXPECT_LE(few.steps_solved, 5 * steps);
  EXPECT_EQ(few.by_start, most.by_start);  // the same bits: steps go on as they did
  EXPECT_EQ(few.by_parameters, most.by_parameters);
}

/// Runs `f` and returns what it refuses, or nothing.
template <class F> std::string refusal_of(const F& f) {
  try {
    f();
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return {};
}
TEST(RunGradients, RefuseWhatHasNone) {
  const auto by = [&](const std::string& name) {
    return refusal_of([&] { sensitivities(spring(), start, {.steps = 3, .parameters = {name}}); });
  };
  EXPECT_EQ(by("stiffness"), "");
  EXPECT_TRUE(by("slope").starts_with("parameter slope carries no derivative: the system reads it as a plain number"))
      << by("slope");
  EXPECT_EQ(by("quadrature"), "parameter quadrature is a choice of words: nothing is differentiable by it");
  EXPECT_EQ(by("mass"), "there is no parameter mass that is a number; there are stiffness, slope");
  const auto explicitly = refusal_of([&] {
    sensitivities<HardSpring>(
        spring(),
        std::make_unique<detail::IntegratorOf<HardSpring, SplittingIntegrator<HardSpring>>>(spring(), start, unit),
        {.steps = 3});
  });
  EXPECT_EQ(explicitly, "steps in closed form have no derivative here: take implicit steps");
}

}  // namespace
}  // namespace lagroid::sensitivity_runs_tests
