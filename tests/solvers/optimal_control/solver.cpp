// The interior point method itself: its linear algebra, what it refuses, what it says of the infeasible; laws that
// fail.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/steered_car.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include "../../support/allocation_counter.hpp"

#include <Eigen/Dense>

#include <random>

namespace lagroid::optimal_control_solver_tests {
namespace {

ControlTask<DoubleIntegrator> rest_to_rest() { return {{}, {{0, 0}, {1, 0}}, 1}; }

TEST(SymmetricFactorsSized, InvertAndCountNegativeEigenvalues) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const int size : {1, 2, 5, 8, 12, 23}) {
    SymmetricFactorSized factor(size);
    for (int sample = 0; sample < 20; ++sample) {
      Eigen::MatrixXd a(size, size);
      for (double& x : a.reshaped()) x = normal(generator);
      a = (a + a.transpose()).eval();
      if (sample % 2 == 0) a.topLeftCorner(size / 2, size / 2).setZero();  // as in a KKT matrix
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues();
      if (eigenvalues.cwiseAbs().minCoeff() < 1e-3) continue;
      factor.compute(a.data(), size);
      EXPECT_EQ(factor.negative(), (eigenvalues.array() < 0).count());
      Rows inverse(size, padded(size));
      factor.invert(inverse.data());
      const Rows identity = Rows::Identity(size, size);
      EXPECT_LT((a * inverse.leftCols(size) - identity).norm(), 1e-9);
      EXPECT_EQ(inverse.rightCols(padded(size) - size).norm(), 0);
    }
  }
}

TEST(SymmetricFactorsSized, ShowASingularMatrix) {
  SymmetricFactorSized factor(2);
  const double singular[] = {1, 1, 1, 1};
  factor.compute(singular, 2);
  EXPECT_LT(factor.smallest(), 1e-15);
  const double none[] = {NAN, 0, 0, 1};
  factor.compute(none, 2);
  EXPECT_EQ(factor.smallest(), 0);
}

TEST(ControlSolvers, BadTasksAreRefusedInWords) {
  auto task = rest_to_rest();
  task.lower(0) = 1;
  task.upper(0) = -1;
  try {
    solve_control(task, 10);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("control 1: its lower bound 1 is not below its upper bound -1"),
              std::string::npos)
        << error.what();
  }
  task = rest_to_rest();
  task.duration = 0;
  EXPECT_THROW(solve_control(task, 10), std::invalid_argument);
  EXPECT_THROW(solve_control(rest_to_rest(), 1), std::invalid_argument);
}

/// Aside by a metre, from rest to rest.
ControlTask<SteeredCar> parking() {
  SteeredCar car;
  car.largest_steering = 0.6;
  using States = FlowStates<SteeredCar::GroupoidType>;
  ControlTask<SteeredCar> task{car, States::arrow({0, 0, 0, 0, 0}, {0, 1, 0, 0, 0}), 6};
  task.lower << -1, -2;
  task.upper << 1, 2;
  return task;
}

// At rest no displacement moves a car aside, to first order: the straight start is a stationary point of the violation.
TEST(ControlSolvers, StartsThatFailEndSoon) {
  const ControlReport parked = solve_control(parking(), 40).report;
  EXPECT_EQ(parked.status, ControlStatus::infeasible);
  EXPECT_LE(parked.iterations, 30);
  ControlTask<SwingUp> swing{{}, {{0, 0}, {3.14159, 0}}, 3};  // too short for this torque
  swing.lower(0) = -0.5;
  swing.upper(0) = 0.5;
  const ControlReport swung = solve_control(swing, 100).report;
  EXPECT_EQ(swung.status, ControlStatus::infeasible);
  EXPECT_LE(swung.iterations, 200);
  EXPECT_GT(swung.violation, 0.1);
}

// The third and the fourth start turn the car around once, for which there is no time; the fifth bends its way.
TEST(ControlSolvers, FiveStartsParkACar) {
  const auto found = search_control(parking(), 40, {.starts = 5});
  EXPECT_EQ(found.outcomes.at(ControlStatus::infeasible), 4);
  ASSERT_EQ(found.minima.size(), 1);
  EXPECT_NEAR(found.minima.front().report.cost, 8.12609, 1e-5);
}

// One second from rest to rest over a distance of one takes a force of four.
TEST(ControlSolvers, AnInfeasibleProblemIsTypedAndNamesWhatIsViolated) {
  auto task = rest_to_rest();
  task.lower(0) = -3;
  task.upper(0) = 3;
  const auto found = solve_control(task, 50);
  EXPECT_EQ(found.report.status, ControlStatus::infeasible);
  EXPECT_FALSE(found.report.worst.empty());
  EXPECT_GT(found.report.violation, 1e-3);
  EXPECT_FALSE(found.report.message.empty());
  task.lower(0) = -4.5;
  task.upper(0) = 4.5;
  EXPECT_TRUE(solve_control(task, 50).report.converged());
}

// Rounding of places of 1e7 violates constraints by 1e-9 and more: what is infeasible is so by more than that.
TEST(ControlSolvers, WhatIsInfeasibleDoesNotDependOnUnits) {
  for (const double distance : {1e7, 1e10}) {
    ControlTask<DoubleIntegrator> task{{}, {{0, 0}, {distance, 0}}, 3};
    task.system.cost_of = ControlCost::time;
    task.duration_is_free = true;
    task.lower(0) = -1;
    task.upper(0) = 1;
    const auto found = solve_control(task, 100);
    ASSERT_TRUE(found.report.converged()) << distance << ": " << found.report.message;
    const double exact = 2 * std::sqrt(distance);
    EXPECT_NEAR(found.report.cost, exact, 1e-9 * exact);
    task.duration_is_free = false;
    task.duration = 0.9 * exact;
    const auto hurried = solve_control(task, 100);
    EXPECT_EQ(hurried.report.status, ControlStatus::infeasible) << distance;
    EXPECT_GT(hurried.report.violation, 1);
  }
}

TEST(ControlSolvers, EndWhereTheyAreInterrupted) {
  auto task = rest_to_rest();
  int asked = 0;
  const auto after = [&](int times) { return [&asked, times] { return ++asked < times; }; };
  const auto early = solve_control(task, 50, {.keep_going = after(1)});
  EXPECT_EQ(early.report.status, ControlStatus::interrupted);
  EXPECT_EQ(early.report.iterations, 0);
  EXPECT_FALSE(early.report.message.empty());
  asked = 0;
  task.lower(0) = -3;  // too little: after a few iterations violations alone are lowered
  task.upper(0) = 3;
  const auto restoring = solve_control(task, 50, {.keep_going = after(12)});
  EXPECT_EQ(restoring.report.status, ControlStatus::interrupted);
  EXPECT_GT(restoring.report.restorations, 0);
  EXPECT_LE(restoring.report.iterations, 12);
  asked = 0;
  task = rest_to_rest();
  task.system.largest_speed = 1.25;
  const auto search = search_control(task, 50, {.starts = 5}, [&](int start) { return start == 0 || ++asked < 4; });
  EXPECT_EQ(search.outcomes.at(ControlStatus::converged), 1);
  EXPECT_EQ(search.outcomes.at(ControlStatus::interrupted), 1);
  EXPECT_EQ(search.outcomes.size(), 2U);
  EXPECT_EQ(search.minima.size(), 1U);
}

// What converged stands, though its active inequalities are not looked for to the end.
TEST(ControlSolvers, AnInterruptedCrossoverLeavesTheInteriorPoint) {
  auto task = rest_to_rest();
  task.system.largest_speed = 1.25;
  const auto whole = solve_control(task, 50);
  ASSERT_TRUE(whole.crossover.crossed());
  int asked = 0;
  const auto found = solve_control(task, 50, {.keep_going = [&] { return ++asked <= whole.report.iterations; }});
  EXPECT_TRUE(found.report.converged());
  EXPECT_EQ(found.crossover.status, CrossoverStatus::interrupted);
  EXPECT_NEAR(found.report.cost, whole.report.cost, 1e-8);
}

TEST(ControlSolvers, AStartThatIsNotFiniteIsTyped) {
  auto start = straight_trajectory(rest_to_rest(), 10);
  start.controls[3](0) = NAN;
  const auto found = solve_control(rest_to_rest(), start);
  EXPECT_EQ(found.report.status, ControlStatus::not_finite);
}

TEST(ControlSolvers, TooFewIterationsAreTypedAndTheLastIterateIsKept) {
  auto task = rest_to_rest();
  task.system.largest_speed = 1.25;
  const auto found = solve_control(task, 50, {.max_iterations = 3});
  EXPECT_EQ(found.report.status, ControlStatus::not_converged);
  EXPECT_EQ(found.trajectory.arrows.size(), 50U);
  EXPECT_TRUE(std::isfinite(found.report.cost));
}

// A free end costs less, and the momentum there vanishes: transversality.
TEST(ControlSolvers, AnEndMayBeFreeInPart) {
  auto task = rest_to_rest();
  const double to_rest = solve_control(task, 100).report.cost;
  task.free_end[1] = true;
  const auto found = solve_control(task, 100);
  ASSERT_TRUE(found.report.converged());
  EXPECT_NEAR(found.report.cost, to_rest / 4, 1e-2);  // 12 and 3, by the calculus of variations
  // lambda is that of the midpoint: carried to the end by half a step it vanishes along what is free.
  const auto& last = found.costates.back();
  EXPECT_NEAR(last[1] - 0.5 * found.trajectory.step() * last[0], 0, 1e-9);
  task = rest_to_rest();
  task.free_start[1] = true;
  EXPECT_NEAR(solve_control(task, 100).report.cost, to_rest / 4, 1e-2);
}

TEST(ControlSolvers, AnIterationTakesNoMemory) {
  auto task = rest_to_rest();
  task.system.largest_speed = 1.25;
  const auto allocations = [&](int iterations) {
    TranscriptionOf<DoubleIntegrator> transcription(task, straight_trajectory(task, 50));
    InteriorPoint solver(transcription, {.max_iterations = iterations});
    const long before = allocation_count();
    solver.solve();
    return allocation_count() - before;
  };
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  // The filter keeps a pair of numbers now and then; all else is there before.
  EXPECT_LE(allocations(10) - allocations(2), 8);
}

/// A problem whose derivatives are not those of its values.
class Broken final : public Transcription {
 public:
  enum class What { gradient, hessian };
  Broken(Transcription& of, What what) : of_(of), what_(what) {}
  const TranscriptionSizes& sizes() const override { return of_.sizes(); }
  const std::vector<bool>& free_start() const override { return of_.free_start(); }
  const std::vector<bool>& free_end() const override { return of_.free_end(); }
  void values(StageValues& out) const override { of_.values(out); }
  void derivatives(const StageRows& lambda, const StageRows& z, StageDerivatives& out) const override {
    of_.derivatives(lambda, z, out);
    (what_ == What::gradient ? out.equality : out.hessian)[3][0] += 1e-3;
  }
  void try_displacement(const TrajectoryDisplacement& by, double fraction) override {
    of_.try_displacement(by, fraction);
  }
  void accept() override { of_.accept(); }

 private:
  Transcription& of_;
  What what_;
};

TEST(BrokenTranscription, FailsTheLawsOfItsDerivatives) {
  ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, true};
  TranscriptionOf<DubinsCar> right(task, control_guess(task, 10, 3));
  EXPECT_TRUE(laws::transcription_laws(right).holds()) << laws::transcription_laws(right);
  Broken gradient(right, Broken::What::gradient);
  EXPECT_FALSE(laws::transcription_laws(gradient).law("the equalities' derivatives are those of their values").holds());
  Broken hessian(right, Broken::What::hessian);
  EXPECT_FALSE(laws::transcription_laws(hessian).law("the Hessian is that of the stage's Lagrangian").holds());
}

TEST(BrokenSolution, FailsTheLawsOfOptimality) {
  auto task = rest_to_rest();
  task.system.largest_speed = 1.25;
  TranscriptionOf<DoubleIntegrator> transcription(task, straight_trajectory(task, 20));
  InteriorPoint solver(transcription);
  ASSERT_TRUE(solver.solve().converged());
  StageRows lambda = solver.costates();
  StageRows z = solver.inequality_multipliers();
  EXPECT_TRUE(laws::optimality_laws(transcription, lambda, z).holds());
  lambda[7][0] += 1e-3;
  EXPECT_FALSE(laws::optimality_laws(transcription, lambda, z).law("the Lagrangian is stationary").holds());
  lambda = solver.costates();
  z[2][0] += 1;
  EXPECT_FALSE(laws::optimality_laws(transcription, lambda, z).law("complementarity").holds());
}

}  // namespace
}  // namespace lagroid::optimal_control_solver_tests
