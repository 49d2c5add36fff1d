// Stationary points from where the cost falls: what a start with a symmetry leads to.
#include "support.hpp"

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/control/flows/reeds_shepp_car.hpp>

namespace lagroid::optimal_control_saddle_tests {
namespace {

/// A point that moves, x' = u, and gains by it: to stand still costs most.
struct Restless : ControlledFlow<Restless, Pair<1>, 1> {
  template <class Q, class S> Vector<S, 1> flow(const Q&, const Vector<S, 1>& u) const { return u; }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 1>& u) const { return -u(0) * u(0); }
};
ControlTask<Restless> back_to_start() { return {{}, {Vector<double, 1>::Zero(), Vector<double, 1>::Zero()}, 1}; }

TEST(Saddles, AreLeftForWhatCostsLess) {
  ControlTask<Restless> task = back_to_start();
  task.lower(0) = -1;
  task.upper(0) = 1;
  TranscriptionOf<Restless> transcription(task, straight_trajectory(task, 10));
  InteriorPoint solver(transcription);
  const ControlReport stands = solver.solve();
  ASSERT_TRUE(stands.converged());
  EXPECT_TRUE(stands.is_saddle());
  EXPECT_EQ(stands.cost, 0);
  const ControlSolution<Restless> found = solve_control(task, 10);
  ASSERT_TRUE(found.report.converged());
  EXPECT_TRUE(found.report.is_strict_minimum());
  EXPECT_TRUE(found.crossover.crossed());
  EXPECT_NEAR(found.report.cost, -1, 1e-12);
  EXPECT_GT(found.report.iterations, stands.iterations);
}

// It may move as fast as it likes, so that nothing below is the best: the saddle is what was found.
TEST(Saddles, AreKeptWhereNothingBelowIsFound) {
  const ControlSolution<Restless> found = solve_control(back_to_start(), 10);
  ASSERT_TRUE(found.report.converged());
  EXPECT_TRUE(found.report.is_saddle());
  EXPECT_EQ(found.report.cost, 0);
  for (const auto& u : found.trajectory.controls) EXPECT_EQ(u(0), 0);
}

// A car that turns where it stands: at no speed its cost is the highest, and it falls the same way to both speeds.
TEST(Saddles, OfACarThatTurnsInPlaceAreLeft) {
  ControlTask<ReedsSheppCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {0, 0, 1}), 5, true};
  task.lower << -1, -1;
  task.upper << 1, 1;
  TranscriptionOf<ReedsSheppCar> transcription(task, straight_trajectory(task, 200));
  InteriorPoint solver(transcription);
  const ControlReport in_place = solver.solve();
  ASSERT_TRUE(in_place.converged());
  EXPECT_TRUE(in_place.is_saddle());
  EXPECT_NEAR(in_place.cost, 1 + task.system.creep, 1e-6);
  const ControlSearch<ReedsSheppCar> found = search_control(task, 200);
  ASSERT_FALSE(found.minima.empty());
  EXPECT_LT(found.minima.front().report.cost, 1.00001);
  EXPECT_FALSE(found.minima.front().report.is_saddle());
}

}  // namespace
}  // namespace lagroid::optimal_control_saddle_tests
