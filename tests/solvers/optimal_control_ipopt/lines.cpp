// Optimal control on pair groupoids by the library and by IPOPT, from the same starts.
#include "support.hpp"

#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/low_thrust.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include <numbers>
#include <utility>

namespace lagroid::optimal_control_ipopt_lines_tests {
namespace {

using ipopt_tests::expect_agreement;
using ipopt_tests::task_on;

TEST(ControlByIpopt, EndsWhereItIsInterrupted) {
  const auto task = task_on<SwingUp>({0, 0}, {std::numbers::pi, 0}, 10);
  int asked = 0;
  const auto found =
      solve_control_by_ipopt(task, straight_trajectory(task, 50), {.keep_going = [&] { return ++asked < 4; }});
  EXPECT_EQ(found.report.status, ControlStatus::interrupted);
  EXPECT_LT(found.report.iterations, 4);
  EXPECT_FALSE(found.report.message.empty());
}

TEST(ControlByIpopt, AgreesOnLinesAndPlanes) {
  for (const auto& [start, end] : {std::pair(Vector<double, 2>(0, 0), Vector<double, 2>(1, 0)),
                                   std::pair(Vector<double, 2>(-1, 1), Vector<double, 2>(2, -0.5)),
                                   std::pair(Vector<double, 2>(1, -0.3), Vector<double, 2>(1.5, 0.8))}) {
    auto fastest = task_on<DoubleIntegrator>(start, end, 3);
    fastest.system.cost_of = ControlCost::time;
    fastest.duration_is_free = true;
    fastest.lower(0) = -1;
    fastest.upper(0) = 1;
    expect_agreement("fastest way", fastest);
  }
  auto limited = task_on<DoubleIntegrator>({0, 0}, {1, 0}, 1);
  limited.system.largest_speed = 1.25;
  expect_agreement("bounded speed", limited);
  auto fastest = task_on<PlanarMass>({0, 0, 1, 0}, {2, 1.5, 0, 0}, 3);
  fastest.system.cost_of = ControlCost::time;
  fastest.system.largest_force = 1;
  fastest.duration_is_free = true;
  expect_agreement("fastest mass", fastest);
  auto round = task_on<PlanarMass>({-1.2, -0.1, 0, 0}, {1.3, -0.3, 0, 0}, 4);
  round.system.disk_radius = 1;
  expect_agreement("round a disk", round);
  auto swing = task_on<SwingUp>({0, 0}, {std::numbers::pi, 0}, 10);
  swing.lower(0) = -0.5;
  swing.upper(0) = 0.5;
  expect_agreement("swing-up", swing);
  auto orbit = task_on<LowThrust>(
      {1, 0, 0, 1}, {-0.980465431295418, -1.1352037429618922, 0.6179266498564948, -0.5336977815803581}, 6);
  orbit.system.largest_thrust = 0.09;
  expect_agreement("orbit", orbit);
}

}  // namespace
}  // namespace lagroid::optimal_control_ipopt_lines_tests
