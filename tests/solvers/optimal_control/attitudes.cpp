// Optimal control of a satellite: cheapest and fastest turns, bounded torques, a direction to be kept out.
#include "support.hpp"

#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include <numbers>

namespace lagroid {
namespace {

using control_tests::expect_laws;
using control_tests::expect_second_order;
using States = FlowStates<SatelliteTurn::GroupoidType>;

ControlTask<SatelliteTurn> turn(const Vector<double, 3>& rotation, double duration, const SatelliteTurn& system = {}) {
  States::State end;
  end << rotation, 0, 0, 0;
  return {system, States::arrow(States::State::Zero(), end, system.avoided), duration};
}

TEST(SatelliteTurns, CheapestWithAndWithoutBounds) {
  auto task = turn(2 * Vector<double, 3>(1, 2, 3).normalized(), 5);
  expect_second_order("free", task, 2.227141563828326, 5.6, true, 1);
  task.lower.setConstant(-0.5);
  task.upper.setConstant(0.5);
  expect_second_order("bounded", task, 2.8171354369898496, 16.5, true, 1);
}

// A half turn of a ball about one axis: three torques at once are faster than that one alone, by 0.3.
TEST(SatelliteTurns, TheFastestHalfTurnIsAboutNoFixedAxis) {
  SatelliteTurn ball;
  ball.inertia.setOnes();
  ball.cost_of = ControlCost::time;
  auto task = turn({0, 0, std::numbers::pi - 1e-9}, 4, ball);
  task.duration_is_free = true;
  task.lower.setConstant(-1);
  task.upper.setConstant(1);
  const auto found = search_control(task, 100, {.starts = 4});
  ASSERT_FALSE(found.minima.empty());
  EXPECT_NEAR(found.minima.front().report.cost, 3.243083277452351, 5 * 3.1 / 1e4);
  EXPECT_LT(found.minima.front().report.cost, 2 * std::sqrt(std::numbers::pi) - 0.25);
}

TEST(SatelliteTurns, KeepOutOfACone) {
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  const auto task = turn(2 * Vector<double, 3>(0.2, 1, 0.1).normalized(), 5, satellite);
  expect_second_order("cone", task, 1.5678571415183247, 2, false, 1);
  expect_laws(task, 20);
}

}  // namespace
}  // namespace lagroid
