// Optimal control in several phases with durations of their own, conditions on the nodes between them and on ends.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include <array>
#include <memory>
#include <numbers>
#include <string>

namespace lagroid::optimal_control_phases_tests {
namespace {

using control_tests::expect_laws;

/// u = +1 or -1 in two phases of two stages and free durations, in the least time.
ControlTask<DoubleIntegrator> bang_bang(const PairArrow<double, 2>& ends, double first_control) {
  ControlTask<DoubleIntegrator> task{{}, ends};
  for (const double control : {first_control, -first_control}) {
    ControlPhase<DoubleIntegrator> phase{.stages = 2, .duration = 2, .duration_is_free = true};
    phase.system.cost_of = ControlCost::time;
    phase.lower(0) = phase.upper(0) = control;
    task.phases.push_back(phase);
  }
  return task;
}

// The midpoint rule is exact for constant forces, so that nothing is left of the envelope of a grid that misses the
// switch (lines_and_planes.cpp), on four stages.
TEST(ControlPhases, SwitchesAtTheirBordersAreExact) {
  struct Case {
    PairArrow<double, 2> ends;
    double first;
    double switched;
    double duration;
  };
  for (const Case& each :
       {Case{{{0, 0}, {1, 0}}, 1, 1, 2}, Case{{{0, 1}, {0, 0}}, -1, 1.7071067811865475, 2.414213562373095},
        Case{{{-1, 1}, {2, -0.5}}, 1, 0.9039432764659772, 3.3078865529319543},
        Case{{{1, -0.3}, {1.5, 0.8}}, 1, 1.2300537618869138, 1.3601075237738276}}) {
    const auto task = bang_bang(each.ends, each.first);
    const auto found = solve_control(task, drifting_trajectory(task, 0).value());
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    EXPECT_NEAR(found.report.cost, each.duration, 1e-12);
    EXPECT_NEAR(2 * found.trajectory.phases[0].step, each.switched, 1e-12);
    EXPECT_NEAR(found.trajectory.duration(), each.duration, 1e-12);
  }
}

// P-SO3-TIME: five switches of three torques. Without phases its error is an envelope; with them the ratio is four.
TEST(ControlPhases, AFastestTurnIsOfOrderTwoAndNotInEnvelopeOnly) {
  const std::array<double, 7> times{0,
                                    0.4454389949446642,
                                    1.1761026437810267,
                                    1.621541638726175,
                                    2.0669806336708394,
                                    2.7976442825072065,
                                    3.243083277452351};
  const std::array<int, 5> switched{1, 0, 2, 1, 0};
  Vector<double, 3> torque(-1, 1, 1);
  SatelliteTurn ball;
  ball.inertia.setOnes();
  ball.cost_of = ControlCost::time;
  using States = FlowStates<SatelliteTurn::GroupoidType>;
  States::State end = States::State::Zero();
  end(2) = std::numbers::pi;
  double errors[3];
  int grid = 0;
  for (const long stages : {5L, 10L, 20L}) {
    ControlTask<SatelliteTurn> task{ball, States::arrow(States::State::Zero(), end, ball.avoided)};
    Vector<double, 3> now = torque;
    // Where a constant torque leads, to begin with.
    for (std::size_t p = 0; p < 6; ++p) {
      task.phases.push_back({.system = ball,
                             .stages = stages,
                             .duration = times[p + 1] - times[p],
                             .duration_is_free = true,
                             .lower = now,
                             .upper = now});
      if (p < 5) now(switched[p]) = -now(switched[p]);
    }
    auto start = drifting_trajectory(task, 0);
    ASSERT_TRUE(start);
    const auto found = solve_control(task, *start);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    errors[grid++] = found.report.cost - times[6];
    EXPECT_LE(found.report.stationarity, 1e-10);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.1);
  EXPECT_NEAR(errors[1] / errors[2], 4, 0.03);
  EXPECT_NEAR((4 * errors[2] - errors[1]) / 3, 0, 1e-6);
}

// The same grid and the same durations: the same answer.
TEST(ControlPhases, OfAnUnsplitProblemGiveItsAnswer) {
  ControlTask<DoubleIntegrator> whole{{}, {{0, 0}, {1, 0}}, 1};
  whole.system.largest_speed = 1.25;
  auto split = whole;
  for (const long stages : {10L, 20L, 30L})
    split.phases.push_back({.system = whole.system, .stages = stages, .duration = double(stages) / 60});
  const auto one = solve_control(whole, 60);
  const auto three = solve_control(split, 0);
  ASSERT_TRUE(one.report.converged() && three.report.converged());
  EXPECT_NEAR(three.report.cost, one.report.cost, 1e-10);
  for (std::size_t k = 0; k < 60; ++k) {
    EXPECT_LE((one.trajectory.arrows[k].target - three.trajectory.arrows[k].target).norm(), 1e-10);
    EXPECT_NEAR(one.trajectory.controls[k](0), three.trajectory.controls[k](0), 1e-10);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(one.costates[k][i], three.costates[k][i], 1e-10);
  }
  // With free durations: by symmetry both halves are as long, and the switch lies between them.
  ControlTask<DoubleIntegrator> fastest{{}, {{0, 0}, {1, 0}}, 3, true};
  fastest.system.cost_of = ControlCost::time;
  fastest.lower(0) = -1;
  fastest.upper(0) = 1;
  auto halves = fastest;
  for (const auto& [least, most] : {std::pair(0.0, 1.0), std::pair(-1.0, 0.0)}) {
    ControlPhase<DoubleIntegrator> phase{
        .system = fastest.system, .stages = 10, .duration = 1.5, .duration_is_free = true};
    phase.lower(0) = least;
    phase.upper(0) = most;
    halves.phases.push_back(phase);
  }
  const auto free = solve_control(fastest, 20);
  const auto both = solve_control(halves, 0);
  ASSERT_TRUE(free.report.converged() && both.report.converged());
  EXPECT_NEAR(both.report.cost, free.report.cost, 1e-10);
  EXPECT_NEAR(both.trajectory.duration(), free.trajectory.duration(), 1e-10);
}

/// (x, y, vx, vy) of a node, of which one is given.
std::shared_ptr<const NodeCondition<Pair<4>>> gate(int component, double value) {
  return node_condition<Pair<4>, 1>(
      [component, value]<class S>(const PairArrow<S, 4>& p) { return Vector<S, 1>(p.target(component) - value); });
}

/// From rest to rest along y in two seconds, through x = 1 after one of them.
ControlTask<PlanarMass> through_a_gate(long stages) {
  ControlTask<PlanarMass> task{{}, {{0, 0, 0, 0}, {0, 1, 0, 0}}};
  task.phases = {{.stages = stages, .end_condition = gate(0, 1)}, {.stages = stages}};
  return task;
}

// x goes there and back, 12 / 1^3 each with rest at the gate by symmetry; y as if there were no gate, 12 / 2^3.
TEST(ControlPhases, TheCostateJumpsAlongTheNormalOfTheGate) {
  double errors[2];
  int grid = 0;
  for (const long stages : {40L, 80L}) {
    const auto found = solve_control(through_a_gate(stages), 0);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    EXPECT_TRUE(found.report.is_strict_minimum());
    errors[grid++] = found.report.cost - 25.5;
    const auto at = std::size_t(stages);
    EXPECT_NEAR(found.trajectory.arrows[at - 1].target(0), 1, 1e-12);
    EXPECT_NEAR(found.trajectory.arrows[at - 1].target(1), 0.5, 1e-9);
    const double jump = found.costates[at - 1][4];
    EXPECT_GT(std::abs(jump), 10);
    // Costates of positions are constant in a phase, of whatever grid.
    for (std::size_t k = 0; k < 2 * at; ++k) {
      const std::size_t other = k < at ? 0 : at;
      EXPECT_NEAR(found.costates[k][0], found.costates[other][0], 1e-9);
      EXPECT_NEAR(found.costates[k][1], found.costates[0][1], 1e-9) << "along the gate";
    }
    EXPECT_NEAR(found.costates[at][0] - found.costates[at - 1][0], jump, 1e-9);
    // Costates of velocities are linear in time, without a jump.
    const double h = found.trajectory.step();
    for (const std::size_t i : {0U, 1U})
      EXPECT_NEAR(found.costates[at][2 + i] - found.costates[at - 1][2 + i],
                  -h * (found.costates[at - 1][i] + found.costates[at][i]) / 2, 1e-9);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.05);
}

// With the times free too, and what stages of a phase may do: laws of derivatives and of optimality, by differences.
TEST(ControlPhases, DerivativesAndOptimality) {
  auto task = through_a_gate(8);
  for (ControlPhase<PlanarMass>& phase : task.phases) {
    phase.duration = 2.5;
    phase.duration_is_free = true;
    phase.system.cost_of = ControlCost::time;
    phase.system.largest_force = 1;
  }
  task.phases[1].lower(0) = -0.9;
  expect_laws(task, 0);
  ControlTask<DubinsCar> car{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1})};
  const auto line = node_condition<SE2, 1>(
      []<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(0, 2) + p(1, 2) * p(1, 2) - 2.5); });
  car.phases = {{.stages = 8, .duration = 2.5, .duration_is_free = true, .end_condition = line},
                {.stages = 7, .duration = 2.5, .duration_is_free = true}};
  for (auto& phase : car.phases) phase.lower(0) = -1, phase.upper(0) = 1;
  TranscriptionOf<DubinsCar> bent(car, control_guess(car, 0, 3));
  const laws::LawReport derivatives = laws::transcription_laws(bent, 3);
  EXPECT_TRUE(derivatives.holds()) << derivatives;
}

// The longest that a phase may last is a bound like others: with its multiplier, and where it is not reached without.
TEST(ControlPhases, DurationsMayBeBounded) {
  auto task = through_a_gate(20);
  for (ControlPhase<PlanarMass>& phase : task.phases) {
    phase.duration_is_free = true;
    phase.shortest = 0.5;
    phase.longest = 1.25;
  }
  const auto found = solve_control(task, 0);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  // The effort falls with the time: 12 / 1.25^3 for either half of x, 12 / 2.5^3 for y.
  EXPECT_NEAR(found.trajectory.duration(), 2.5, 1e-12);
  EXPECT_NEAR(found.report.cost, 24 / std::pow(1.25, 3) + 12 / std::pow(2.5, 3), 0.1);
  EXPECT_GT(found.inequality_multipliers[20][2], 1);
  EXPECT_EQ(found.inequality_multipliers[20][3], 0);
  TranscriptionOf<PlanarMass> bent(task, control_guess(task, 0, 3));
  const laws::LawReport derivatives = laws::transcription_laws(bent, 2);
  EXPECT_TRUE(derivatives.holds()) << derivatives;
}

// Without bounds a poor start shrinks a phase to nothing, where the violation is stationary in the logarithm of its
// time. (Straight starts of two phases of equal times are saddles of the violation, which no derivative leads away
// from.)
TEST(ControlPhases, BoundsKeepAPhaseFromShrinkingToNothing) {
  const auto converged = [](bool bounded) {
    int count = 0;
    for (const double first : {0.5, 1.0, 2.0})
      for (const double second : {0.6, 1.1, 2.2}) {
        auto task = bang_bang({{0, 1}, {0, 0}}, -1);
        task.phases[0].duration = first;
        task.phases[1].duration = second;
        for (auto& phase : task.phases)
          if (bounded) phase.shortest = 0.05, phase.longest = 10;
        for (const auto& start : {straight_trajectory(task), drifting_trajectory(task, 0).value()})
          count += solve_control(task, start).report.converged() ? 1 : 0;
      }
    return count;
  };
  EXPECT_LE(converged(false), 17);
  EXPECT_EQ(converged(true), 18);
}

/// A condition whose derivatives are not those of its values.
class BrokenGate final : public NodeCondition<Pair<4>> {
 public:
  int size() const override { return 1; }
  void values(const Pair<4>& groupoid, const PairArrow<double, 4>& node, double* out) const override {
    gate(0, 1)->values(groupoid, node, out);
  }
  void derivatives(const Pair<4>& groupoid, const PairArrow<double, 4>& node, const double* lambda, double* rows,
                   double* hessian) const override {
    gate(0, 1)->derivatives(groupoid, node, lambda, rows, hessian);
    rows[1] += 1e-3;
  }
};

TEST(BrokenNodeCondition, FailsTheLawsOfItsDerivatives) {
  auto task = through_a_gate(4);
  TranscriptionOf<PlanarMass> right(task, control_guess(task, 0, 3));
  EXPECT_TRUE(laws::transcription_laws(right).holds());
  task.phases[0].end_condition = std::make_shared<const BrokenGate>();
  TranscriptionOf<PlanarMass> broken(task, control_guess(task, 0, 3));
  EXPECT_FALSE(laws::transcription_laws(broken).law("the equalities' derivatives are those of their values").holds());
}

// Straight ahead to the circle about (6, 0); and where its centre is aside, an arc and a line that points to it.
TEST(ControlEnds, OnACircleAreWhereItsNormalSays) {
  const double radius = 2;
  for (const auto& center : {Vector<double, 2>(6, 0), Vector<double, 2>(5, 4)}) {
    ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {center(0), center(1) - radius, 0.3}), 5, true};
    task.lower(0) = -1;
    task.upper(0) = 1;
    task.free_end = {true, true, true};
    task.end_condition = node_condition<SE2, 1>([center, radius]<class S>(const Matrix<S, 3, 3>& p) {
      const S x = p(0, 2) - center(0);
      const S y = p(1, 2) - center(1);
      return Vector<S, 1>(x * x + y * y - radius * radius);
    });
    // An arc of the circle about (0, 1), then along its tangent, which leads to the center.
    const double apart = (center - Vector<double, 2>(0, 1)).norm();
    const double line = std::sqrt(apart * apart - 1);
    const double arc = center(1) == 0 ? 0 : std::atan2(center(1) - 1, center(0)) - std::atan2(-1, line);
    const double length = center(1) == 0 ? 6 - radius : arc + line - radius;
    const auto found = search_control(task, 100, {.starts = 3});
    ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
    EXPECT_NEAR(found.minima.front().report.cost, length, 1e-4);
  }
}

// From a circle to a point outside: along the normal, and the pose of the first node is known.
TEST(ControlEnds, TheStartMayBeOnASet) {
  ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {3, 1, 0}), 3, true};
  task.lower(0) = -1;
  task.upper(0) = 1;
  task.free_start = {true, true, true};
  task.start_condition = node_condition<SE2, 1>([]<class S>(const Matrix<S, 3, 3>& p) {
    return Vector<S, 1>(p(0, 2) * p(0, 2) + (p(1, 2) - 1.0) * (p(1, 2) - 1.0) - 1.0);
  });
  const auto found = search_control(task, 40, {.starts = 4});
  ASSERT_FALSE(found.minima.empty()) << found.best_failure.report.message;
  const auto& best = found.minima.front();
  EXPECT_NEAR(best.report.cost, 2, 1e-6);
  ASSERT_TRUE(best.trajectory.start);
  EXPECT_NEAR((*best.trajectory.start)(0, 2), 1, 1e-5);
  EXPECT_NEAR((*best.trajectory.start)(1, 2), 1, 1e-5);
}

// There and back in a second each: from rest to a gate at one, and to rest, takes a force of four and more.
TEST(ControlPhases, LinksThatCannotBeAreTypedAndNamed) {
  const auto at_one =
      node_condition<Pair<2>, 1>([]<class S>(const PairArrow<S, 2>& p) { return Vector<S, 1>(p.target(0) - 1.0); });
  const auto solved = [&](double force) {
    ControlTask<DoubleIntegrator> task{{}, {{0, 0}, {0, 0}}};
    task.phases = {{.stages = 20, .end_condition = at_one}, {.stages = 20}};
    for (auto& phase : task.phases) phase.lower(0) = -force, phase.upper(0) = force;
    return solve_control(task, 0, {.max_iterations = 2000}).report;
  };
  const ControlReport found = solved(3);
  EXPECT_EQ(found.status, ControlStatus::infeasible);
  EXPECT_FALSE(found.worst.empty());
  EXPECT_FALSE(found.message.empty());
  EXPECT_TRUE(solved(4.5).converged());
}

TEST(ControlPhases, BadOnesAreRefusedInWords) {
  const auto said = [](const auto& task) -> std::string {
    try {
      solve_control(task, 0);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  auto task = through_a_gate(4);
  task.phases[1].duration = 0;
  EXPECT_EQ(said(task), "phase 2: duration: 0 is not positive");
  task = through_a_gate(4);
  task.phases[1].lower(0) = 2;
  task.phases[1].upper(0) = 1;
  EXPECT_EQ(said(task), "phase 2: control 1: its lower bound 2 is not below its upper bound 1");
  task = through_a_gate(4);
  task.end_condition = gate(0, 0);
  EXPECT_NE(said(task).find("that end is free in part"), std::string::npos);
  auto start = straight_trajectory(through_a_gate(4));
  start.phases.pop_back();
  EXPECT_THROW(solve_control(through_a_gate(4), start), std::invalid_argument);
}

// A phase without its path constraint cuts through the disk.
TEST(ControlPhases, AConstraintHoldsInItsPhaseAlone) {
  ControlTask<PlanarMass> task{{}, {{-2, -0.3, 0, 0}, {2, 0.2, 0, 0}}, 4};
  task.system.disk_radius = 1;
  task.phases = {{.system = task.system, .stages = 30, .duration = 2},
                 {.system = task.system, .stages = 30, .duration = 2}};
  const auto kept = search_control(task, 0, {.starts = 3});
  task.phases[1].inequalities_hold = false;
  const auto cut = search_control(task, 0, {.starts = 3});
  ASSERT_FALSE(kept.minima.empty());
  ASSERT_FALSE(cut.minima.empty());
  EXPECT_LT(cut.minima.front().report.cost, kept.minima.front().report.cost - 1e-3);
  const auto& arrows = cut.minima.front().trajectory.arrows;
  for (std::size_t k = 0; k < 30; ++k) EXPECT_GE(arrows[k].target.head<2>().norm(), 1 - 1e-9);
}

}  // namespace
}  // namespace lagroid::optimal_control_phases_tests
