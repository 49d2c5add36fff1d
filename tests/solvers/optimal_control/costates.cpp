// Extremals are motions of a discrete Hamiltonian system, bounds or not.
#include "support.hpp"

#include <lagroid/solvers/control/testing/costate_laws.hpp>
#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

namespace lagroid::optimal_control_costates_tests {
namespace {

using States = FlowStates<SatelliteTurn::GroupoidType>;

ControlTask<SatelliteTurn> turn() {
  States::State end;
  end << 2 * Vector<double, 3>(1, 2, 3).normalized(), 0, 0, 0;
  return {{}, States::arrow(States::State::Zero(), end, SatelliteTurn{}.avoided), 5};
}
ControlTask<SwingUp> swing() {
  ControlTask<SwingUp> task{{}, {{0, 0}, {2, 0}}, 3};
  task.lower(0) = -1;
  task.upper(0) = 1;
  return task;
}

template <class Sys> void expect_symplectic(const ControlTask<Sys>& task, bool has_active) {
  const auto found = solve_control(task, 40);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  const std::vector<bool> active = laws::detail::active_in(found);
  EXPECT_EQ(std::find(active.begin(), active.end(), true) != active.end(), has_active);
  const laws::LawReport report = laws::costate_laws(task, found);
  EXPECT_TRUE(report.holds()) << report;
}

TEST(Costates, AreThoseOfASymplecticMap) {
  expect_symplectic(turn(), false);
  expect_symplectic(swing(), true);
  ControlTask<DoubleIntegrator> bounded{{}, {{0, 0.1}, {1, 0.2}}, 2};
  bounded.lower(0) = -0.9;
  bounded.upper(0) = 0.9;
  expect_symplectic(bounded, true);
}
TEST(Costates, AreOnABoundedTurnToo) {
  auto task = turn();
  task.lower.setConstant(-0.5);
  task.upper.setConstant(0.5);
  expect_symplectic(task, true);
}

/// Costates that are wrong at one stage by a share of the ends' displacement.
TEST(Costates, ThatAreWrongAreNot) {
  const auto wrong = [](const auto& task, auto from) {
    auto found = laws::FoundExtremals{}(task, std::move(from));
    for (double& each : found.costates[20]) each *= 1 + 0.1 * (found.trajectory.arrows.front().target(0));
    return found;
  };
  const auto task = swing();
  const laws::LawReport report = laws::costate_laws(task, solve_control(task, 40), wrong);
  EXPECT_FALSE(report.holds()) << report;
  EXPECT_FALSE(report.laws.front().unjudged) << report;
}

/// Nothing is said then.
TEST(Costates, ActiveSetsThatChangeAreTold) {
  const auto task = swing();
  const auto shifts = [](const auto& of, auto from) {
    auto found = laws::FoundExtremals{}(of, std::move(from));
    found.inequality_multipliers[3].back() = 1;
    return found;
  };
  const laws::LawReport report = laws::costate_laws(task, solve_control(task, 40), shifts);
  EXPECT_TRUE(report.laws.front().unjudged) << report;
}

}  // namespace
}  // namespace lagroid::optimal_control_costates_tests
