// Discrete systems of the library moved by controlled forces: their own steps where there are none, and known optima.
#include "support.hpp"

#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/control/actuated/pushed.hpp>
#include <lagroid/systems/control/flows/steered_sleigh.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

#include <cmath>
#include <numbers>
#include <type_traits>

namespace lagroid::optimal_control_actuated_tests {
namespace {

using control_tests::expect_laws;
using control_tests::expect_second_order;

/// How far the system's own steps are from the equations, the controls zero.
template <class Sys> double defect_of_steps(const Sys& system, State<typename Sys::GroupoidType> state) {
  Pushed<Sys, 1> pushed;
  pushed.system = system;
  NewtonStep<Sys> newton;
  double worst = 0;
  for (int k = 0; k < 20; ++k) {
    StepSolution<Sys> found{{system.groupoid.unit(state.object), Sys::Multipliers::Zero()}, {}};
    EXPECT_TRUE(newton.solve(system, state, found).converged());
    const auto next = legendre_plus(system, found.step);
    Vector<double, Pushed<Sys, 1>::all_controls> u;
    u << 0.0, found.step.multipliers;
    const auto off = pushed.constraint(
        std::tuple(found.step.arrow, PairArrow<double, Sys::dimension>{state.momentum, next.momentum}), u, system.h);
    worst = std::max(worst, off.cwiseAbs().maxCoeff());
    state = next;
  }
  return worst;
}

TEST(ActuatedSystems, WithoutForcesMakeTheStepsOfTheSystem) {
  RigidBody body;
  EXPECT_LE(defect_of_steps(body, {{}, {0.1, 1, 0.2}}), 1e-13);
  DampedPendulum damped;
  damped.h = 0.05;
  damped.damping = 0.3;
  EXPECT_LE(defect_of_steps(damped, {Vector<double, 1>(1.0), Vector<double, 1>(0.2)}), 1e-13);
  ChaplyginSleigh sleigh;
  EXPECT_LE(defect_of_steps(sleigh, sleigh.sliding(0.5, 1)), 1e-13);
}

ControlTask<Pushed<Pendulum, 1>> swing_up() {
  const auto point = [](double x) { return Vector<double, 1>(x); };
  return {{}, {{point(0), point(std::numbers::pi)}, {point(0), point(0)}}, 10};
}

TEST(ActuatedSystems, SwingUpAtTheKnownCost) {
  auto task = swing_up();
  expect_second_order("free", task, 1.1611196661425072, 28.6, true);
  const double cost = solve_control(task, 50).report.cost;
  task.system.weights = {{Vector<double, 1>(2.0), 0.1}};
  EXPECT_NEAR(solve_control(task, 50).report.cost, 2 * cost + 0.1 * 10, 1e-11);
  task.system.weights.reset();
  task.lower(0) = -0.5;
  task.upper(0) = 0.5;
  expect_second_order("bounded", task, 1.1639915199984323, 29.3, true);
  expect_laws(task, 30);
}

TEST(ActuatedSystems, TurnABodyAtTheKnownCost) {
  ControlTask<Pushed<RigidBody, 3>> task;
  task.boundary = {SO3::exp(Vector<double, 3>(2 * Vector<double, 3>(1, 2, 3).normalized())),
                   {Vector<double, 3>::Zero(), Vector<double, 3>::Zero()}};
  task.duration = 5;
  expect_laws(task, 10);
  const auto found = search_control(task, 40, {.starts = 1});
  ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
  EXPECT_NEAR(found.minima.front().report.cost, 2.227141563828326, 5 * 5.6 / 1600);
}

// A body of tons takes torques a thousand times those of one of kilograms, and a million times the cost.
TEST(ActuatedSystems, SolutionsDoNotDependOnUnitsOfMass) {
  ControlTask<Pushed<RigidBody, 3>> body;
  body.boundary = {SO3::exp(Vector<double, 3>(2 * Vector<double, 3>(1, 2, 3).normalized())),
                   {Vector<double, 3>::Zero(), Vector<double, 3>::Zero()}};
  body.duration = 5;
  auto pendulum = swing_up();
  const auto cost_in = [](auto& task, double bound) {
    task.lower.setConstant(-bound);
    task.upper.setConstant(bound);
    const auto found = search_control(task, 100, {.starts = 3});
    EXPECT_FALSE(found.minima.empty()) << bound << ": " << found.best_failure.report.message;
    return found.minima.empty() ? 0 : found.minima.front().report.cost;
  };
  const double turn = cost_in(body, 0.5);
  const double swing = cost_in(pendulum, 0.5);
  body.system.system.inertia *= 1000;
  pendulum.system.system.bob_mass *= 1000;
  EXPECT_NEAR(cost_in(body, 500), 1e6 * turn, 1e-9 * 1e6 * turn);
  EXPECT_NEAR(cost_in(pendulum, 500), 1e6 * swing, 1e-9 * 1e6 * swing);
}

TEST(ActuatedSystems, StartsThatTakeLongAreGivenUp) {
  ControlTask<Pushed<RigidBody, 3>> task;
  task.boundary = {SO3::exp(Vector<double, 3>(2 * Vector<double, 3>(1, 2, 3).normalized())),
                   {Vector<double, 3>::Zero(), Vector<double, 3>::Zero()}};
  task.duration = 5;
  task.lower.setConstant(-0.5);
  task.upper.setConstant(0.5);
  const auto found = search_control(task, 20, {.starts = 4});
  ASSERT_FALSE(found.minima.empty());
  ASSERT_GT(found.outcomes.count(ControlStatus::not_converged), 0U);  // 500 iterations each, without patience
  int slowest = 0;
  for (const auto& each : found.minima) slowest = std::max(slowest, each.report.iterations);
  EXPECT_LE(found.iterations, 4 * std::max(100, 4 * slowest));
}

// A sleigh on a blade, as its equations reduced by hand have it: the reaction is not the control's to make.
TEST(ActuatedSystems, MoveASleighAsideAtTheCostOfItsFlow) {
  using States = FlowStates<SteeredSleigh::GroupoidType>;
  ControlTask<SteeredSleigh> flow{{}, {}, 4};
  flow.system.inertia = 1;
  States::State aside = States::State::Zero();
  aside(1) = 1;
  flow.boundary = States::arrow(States::State::Zero(), aside);
  ControlTask<Pushed<ChaplyginSleigh, 2>> task;
  task.system.system.offset = flow.system.ahead;
  task.boundary = {std::get<0>(flow.boundary), {Vector<double, 3>::Zero(), Vector<double, 3>::Zero()}};
  task.duration = 4;
  task.free_start[5] = task.free_end[5] = true;
  const auto cheapest = [](const auto& of, long stages) {
    const auto found = search_control(of, stages, {.starts = 4});
    EXPECT_FALSE(found.minima.empty()) << found.best_failure.report.message;
    return found.minima.empty() ? std::nan("") : found.minima.front().report.cost;
  };
  const double reference = (4 * cheapest(flow, 100) - cheapest(flow, 50)) / 3;
  const double coarse = cheapest(task, 20);
  const double fine = cheapest(task, 40);
  EXPECT_NEAR((4 * fine - coarse) / 3, reference, 1e-3 * reference);
  EXPECT_NEAR(std::log2((coarse - reference) / (fine - reference)), 2, 0.2);
}

/// A bob on a rod in space, moved along the circle in the plane of x and z by a force, and across it by another.
struct PushedBob : ActuatedSystem<PushedBob, SphericalPendulum, 2> {
  template <class Q, class S> Vector<S, 3> force(const Q& q, const Vector<S, 2>& u) const {
    return {-q(2) * u(0), u(1), q(0) * u(0)};
  }
  template <class State, class S> S running_cost(const State&, const Vector<S, 2>& u) const {
    return u(0) * u(0) + u(1) * u(1);
  }
};

// An object constraint: the same motion as in an angle, which is free of it.
TEST(ActuatedSystems, SwingABobOnItsRodAtTheCostOfItsAngle) {
  constexpr double angle = 1.2;
  ControlTask<Pushed<Pendulum, 1>> in_angle;
  in_angle.boundary = {{Vector<double, 1>(0.0), Vector<double, 1>(angle)}, {}};
  std::get<1>(in_angle.boundary) = {Vector<double, 1>(0.0), Vector<double, 1>(0.0)};
  in_angle.duration = 2;
  const auto reference_on = [&](long stages) { return solve_control(in_angle, stages).report.cost; };
  const double reference = (4 * reference_on(200) - reference_on(100)) / 3;

  using G = PushedBob::GroupoidType;
  const Vector<double, 3> end(std::sin(angle), 0, -std::cos(angle));
  ControlTask<PushedBob> task;
  task.duration = 2;
  task.boundary = {{Vector<double, 3>(0, 0, -1), end}, {Vector<double, 3>::Zero(), Vector<double, 3>::Zero()}};
  // At rest but for what the rod takes, which is along it.
  task.free_start[5] = true;
  task.free_end[3] = task.free_end[4] = task.free_end[5] = true;
  task.end_condition = node_condition<G, 2>([end](const auto& p) {
    const auto& momentum = std::get<1>(p).target;
    using S = typename std::decay_t<decltype(momentum)>::Scalar;
    return Vector<S, 2>(momentum(0) * -end(2) + momentum(2) * end(0), momentum(1));
  });
  double costs[2];
  int grid = 0;
  for (const long stages : {20L, 40L}) {
    const auto found = solve_control(task, stages);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    costs[grid++] = found.report.cost;
    for (const auto& [arrow, momenta] : found.trajectory.arrows) EXPECT_NEAR(arrow.target.norm(), 1, 1e-12);
  }
  EXPECT_NEAR((4 * costs[1] - costs[0]) / 3, reference, 1e-4 * reference);
  EXPECT_NEAR(std::log2((costs[0] - reference) / (costs[1] - reference)), 2, 0.1);
  expect_laws(task, 6);
}

}  // namespace
}  // namespace lagroid::optimal_control_actuated_tests
