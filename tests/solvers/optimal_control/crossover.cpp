// From interior points to active sets: digits where inequalities are strictly active, a type where they are not, and
// what a solution is on finer grids.
#include "support.hpp"

#include <lagroid/solvers/control/testing/control_solution_laws.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include "../../support/allocation_counter.hpp"

#include <numbers>

namespace lagroid::optimal_control_crossover_tests {
namespace {

ControlTask<DubinsCar> shortest_way() {
  ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, true};
  task.lower(0) = -1;
  task.upper(0) = 1;
  return task;
}

ControlTask<DoubleIntegrator> rest_to_rest() {
  ControlTask<DoubleIntegrator> task{{}, {{0, 0}, {1, 0}}, 1};
  task.system.largest_speed = 1.25;
  return task;
}

// Bounds, a bound on the state, a disk; controls that are all at their bounds but one.
TEST(Crossovers, LeaveNoComplementarityAndRoundOffOfTheRest) {
  const auto expect_digits = [](const auto& task, const std::string& name) {
    const auto found = solve_control(task, 100);
    ASSERT_TRUE(found.report.converged()) << name << found.report.message;
    ASSERT_TRUE(found.crossover.crossed()) << name << to_string(found.crossover.status);
    EXPECT_GT(found.crossover.before.complementarity, 1e-12) << name;
    EXPECT_LT(found.crossover.after.largest(), 1e-13) << name;
    EXPECT_EQ(found.crossover.after.sign, 0) << name;
    EXPECT_GT(found.crossover.active, 0) << name;
    EXPECT_EQ(found.report.complementarity, found.crossover.after.complementarity) << name;
  };
  expect_digits(shortest_way(), "Dubins");
  expect_digits(rest_to_rest(), "speed");
  ControlTask<PlanarMass> around{{}, {{-1.2, -0.1, 0, 0}, {1.3, -0.3, 0, 0}}, 4};
  around.system.disk_radius = 1;
  expect_digits(around, "disk");
  ControlTask<DoubleIntegrator> fastest{{}, {{0, 1}, {0, 0}}, 3};
  fastest.system.cost_of = ControlCost::time;
  fastest.duration_is_free = true;
  fastest.lower(0) = -1;
  fastest.upper(0) = 1;
  expect_digits(fastest, "bang-bang");
}

// The same solution, and multipliers that are zero where nothing is active.
TEST(Crossovers, StayWhereTheInteriorPointIs) {
  const auto crossed = solve_control(shortest_way(), 100);
  const auto interior = solve_control(shortest_way(), 100, {.crossover = false});
  EXPECT_EQ(interior.crossover.status, CrossoverStatus::not_tried);
  EXPECT_NEAR(crossed.report.cost, interior.report.cost, 1e-8);
  double least = 1;
  long zeros = 0;
  for (std::size_t k = 0; k < 100; ++k) {
    EXPECT_NEAR(crossed.trajectory.controls[k](0), interior.trajectory.controls[k](0), 1e-6);
    for (std::size_t i = 0; i < 2; ++i) {
      least = std::min(least, interior.inequality_multipliers[k][i]);
      zeros += crossed.inequality_multipliers[k][i] == 0;
    }
  }
  EXPECT_GT(least, 0);
  EXPECT_EQ(zeros, 200 - crossed.crossover.active);
}

// A guess that is wrong: of a solution whose multipliers were taken away, and given to others.
TEST(Crossovers, CorrectAGuessOrSayThatTheyCannot) {
  const auto task = rest_to_rest();
  TranscriptionOf<DoubleIntegrator> transcription(task, straight_trajectory(task, 100));
  InteriorPoint solver(transcription);
  ASSERT_TRUE(solver.solve().converged());
  StageRows z = solver.inequality_multipliers();
  long left_out = -1;
  for (long k = 0; k < 100 && left_out < 0; ++k)
    for (int i = 0; i < z.length(); ++i)
      if (z[k][i] > 1e-3) {
        z[k][i] = 0;
        left_out = k;
        break;
      }
  ASSERT_GE(left_out, 0);
  Crossover crossover(transcription);
  const CrossoverReport report = crossover.cross(solver.costates(), z);
  EXPECT_TRUE(report.crossed()) << to_string(report.status);
  EXPECT_GT(report.changes, 0);
  EXPECT_GT(largest_entry(crossover.inequality_multipliers()), 1e-3);
}

// There is no smaller residual than round-off, so that of two that are, either may be the smaller.
TEST(Crossovers, LeadFromRoundOffToRoundOff) {
  const auto task = rest_to_rest();
  TranscriptionOf<DoubleIntegrator> transcription(task, straight_trajectory(task, 100));
  InteriorPoint solver(transcription);
  ASSERT_TRUE(solver.solve().converged());
  Crossover crossover(transcription);
  ASSERT_TRUE(crossover.cross(solver.costates(), solver.inequality_multipliers()).crossed());
  for (int again = 0; again < 5; ++again) {
    const StageRows costates = crossover.costates(), multipliers = crossover.inequality_multipliers();
    const CrossoverReport report = crossover.cross(costates, multipliers);
    EXPECT_TRUE(report.crossed()) << to_string(report.status);
    EXPECT_LE(report.after.largest(), 1e-13);
  }
}

/// To go unevenly is cheaper, so that a steady way is the dearest.
struct Sprinter : ControlledFlow<Sprinter, Pair<1>, 1> {
  template <class Q, class S> Vector<S, 1> flow(const Q&, const Vector<S, 1>& u) const { return u; }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 1>& u) const { return -u(0) * u(0); }
};

TEST(Crossovers, AreTypedWhereThereIsNoMinimum) {
  using One = Vector<double, 1>;
  const ControlTask<Sprinter> task{{}, {One(0.0), One(1.0)}, 1};
  TranscriptionOf<Sprinter> transcription(task, straight_trajectory(task, 10));
  Crossover crossover(transcription);
  const CrossoverReport report = crossover.cross(StageRows(10, 1), StageRows(10, 0));
  EXPECT_EQ(report.status, CrossoverStatus::degenerate) << to_string(report.status);
}

TEST(Crossovers, TakeNoMemoryOnTheirWay) {
  const auto task = rest_to_rest();
  TranscriptionOf<DoubleIntegrator> transcription(task, straight_trajectory(task, 50));
  InteriorPoint solver(transcription);
  ASSERT_TRUE(solver.solve().converged());
  Crossover crossover(transcription);
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  const long before = allocation_count();
  crossover.cross(solver.costates(), solver.inequality_multipliers());
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(ControlSolutions, SatisfyTheirLawsOnFinerGrids) {
  const auto expect_laws_of = [](const auto& task) {
    const laws::LawReport report = laws::control_solution_laws(task, solve_control(task, 50));
    EXPECT_TRUE(report.holds()) << report;
  };
  expect_laws_of(shortest_way());
  expect_laws_of(ControlTask<DoubleIntegrator>{{}, {{0, 0}, {1, 0}}, 1});
  expect_laws_of(ControlTask<SwingUp>{{}, {{0, 0}, {std::numbers::pi, 0}}, 10});
}

/// However large, as along half an orbit: what falls by four from grid to grid is of order two.
TEST(ControlSolutions, AreOfOrderTwoWhereTheirErrorsFallByFour) {
  const double of_order_two[] = {1.16, 1.04, 1.01};
  const double of_none[] = {1.16, 1.04, 1.10};
  EXPECT_TRUE(laws::detail::order_law(of_order_two, 100, true).holds());
  EXPECT_FALSE(laws::detail::order_law(of_none, 100, true).holds());
}

/// Euler's steps in place of the midpoint rule's.
struct EulerPendulum : ControlSystem<EulerPendulum, Pair<2>, 1, 2> {
  template <class S> S cost(const PairArrow<S, 2>&, const Vector<S, 1>& u, const S& h) const { return h * u(0) * u(0); }
  template <class S> Vector<S, 2> constraint(const PairArrow<S, 2>& g, const Vector<S, 1>& u, const S& h) const {
    using std::sin;
    return {g.target(0) - g.source(0) - h * g.source(1), g.target(1) - g.source(1) - h * (u(0) - sin(g.source(0)))};
  }
};

TEST(BrokenControlSolutions, FailTheLawsOfTheirGridsAndResiduals) {
  const ControlTask<EulerPendulum> task{{}, {{0, 0}, {std::numbers::pi, 0}}, 10};
  const auto found = solve_control(task, 100);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  const laws::LawReport first = laws::control_solution_laws(task, found);
  EXPECT_FALSE(first.law("the cost is of order two in the step").holds()) << first;
  EXPECT_TRUE(first.law("the KKT residual vanishes").holds()) << first;
  auto wrong = solve_control(rest_to_rest(), 50);
  wrong.costates[7][0] += 1e-9;
  EXPECT_FALSE(laws::control_solution_laws(rest_to_rest(), wrong).law("the KKT residual vanishes").holds());
  // Grids without a solution have no order.
  EXPECT_FALSE(laws::control_solution_laws(rest_to_rest(), solve_control(rest_to_rest(), 50), {.max_iterations = 0})
                   .law("the cost is of order two in envelope")
                   .holds());
}

}  // namespace
}  // namespace lagroid::optimal_control_crossover_tests
