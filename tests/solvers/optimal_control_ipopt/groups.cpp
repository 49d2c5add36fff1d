// Optimal control on SO(3) and SE(2) by the library and by IPOPT, from the same starts.
#include "support.hpp"

#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/hovercraft.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/control/flows/steered_car.hpp>
#include <lagroid/systems/control/flows/steered_sleigh.hpp>

#include <numbers>

namespace lagroid::optimal_control_ipopt_groups_tests {
namespace {

using ipopt_tests::expect_agreement;
using ipopt_tests::task_on;

ControlTask<SatelliteTurn> turn(const Vector<double, 3>& rotation, const SatelliteTurn& system = {}) {
  using States = FlowStates<SatelliteTurn::GroupoidType>;
  States::State end;
  end << rotation, 0, 0, 0;
  return {system, States::arrow(States::State::Zero(), end, system.avoided), 5};
}

TEST(ControlByIpopt, AgreesOnAttitudes) {
  auto bounded = turn(2 * Vector<double, 3>(1, 2, 3).normalized());
  bounded.lower.setConstant(-0.5);
  bounded.upper.setConstant(0.5);
  expect_agreement("bounded torques", bounded);
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  expect_agreement("cone", turn(2 * Vector<double, 3>(0.2, 1, 0.1).normalized(), satellite));
}

TEST(ControlByIpopt, AgreesOnPoses) {
  auto dubins = task_on<DubinsCar>({0, 0, 0}, {4, 2, std::numbers::pi / 3}, 5);
  dubins.duration_is_free = true;
  dubins.lower(0) = -1;
  dubins.upper(0) = 1;
  expect_agreement("shortest way", dubins);
  FlowStates<Hovercraft::GroupoidType>::State end;
  end << 1, 1, -1.5 * std::numbers::pi, 0, 0, 0;
  auto hovercraft = task_on<Hovercraft>(FlowStates<Hovercraft::GroupoidType>::State::Zero(), end, 4);
  hovercraft.lower << -1.1, -0.75;
  hovercraft.upper << 1.1, 0.75;
  expect_agreement("hovercraft", hovercraft);
  auto sleigh = task_on<SteeredSleigh>(FlowStates<SteeredSleigh::GroupoidType>::State::Zero(), {2, 1, 0, 0, 0}, 4);
  sleigh.lower << -0.8, -0.25;
  sleigh.upper << 0.8, 0.25;
  expect_agreement("sleigh", sleigh);
  auto car = task_on<SteeredCar>(FlowStates<SteeredCar::GroupoidType>::State::Zero(), {3, 1.5, 0.5, 0, 0}, 5);
  car.system.largest_steering = 0.4;
  expect_agreement("car", car);
}

TEST(ControlByIpopt, AgreesOnPhases) {
  auto task = task_on<DubinsCar>({0, 0, 0}, {4, 2, std::numbers::pi / 3}, 5);
  const auto gate = node_condition<SE2, 1>(
      []<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(0, 2) + p(1, 2) * p(1, 2) - 2.5); });
  task.phases = {{.stages = 15, .duration = 3, .duration_is_free = true, .shortest = 0.5, .end_condition = gate},
                 {.stages = 25, .duration = 3, .duration_is_free = true}};
  for (auto& phase : task.phases) phase.lower(0) = -1, phase.upper(0) = 1;
  expect_agreement("gate", task);
}

}  // namespace
}  // namespace lagroid::optimal_control_ipopt_groups_tests
