// The program that IPOPT is given has the derivatives of its values, by IPOPT's own test of first and second ones.
#include "../../systems/controlled_bodies/scenes.hpp"

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/control/ipopt/ipopt_program.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/multibody/control/ipopt/scene_chart.hpp>

#include <IpIpoptApplication.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace lagroid::optimal_control_ipopt_derivatives_tests {
namespace {

using namespace controlled_bodies_tests;

/// What IPOPT says of derivatives at a trajectory that is displaced at random, by 0.3 at most, from the chart's origin.
std::string told_of_derivatives(TrajectoryChart& chart, ControlProgram::Blocks blocks) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  std::ostringstream told;
  const Ipopt::SmartPtr<Ipopt::StreamJournal> journal = new Ipopt::StreamJournal("told", Ipopt::J_ITERSUMMARY);
  journal->SetOutputStream(&told);
  application->Jnlst()->AddJournal(Ipopt::GetRawPtr(journal));
  application->Options()->SetStringValue("derivative_test", "second-order");
  application->Options()->SetNumericValue("derivative_test_tol", 1e-5);
  application->Options()->SetNumericValue("point_perturbation_radius", 0.3);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetIntegerValue("max_iter", 0);
  application->Initialize();
  const Ipopt::SmartPtr<ControlProgram> program = new ControlProgram(chart, blocks);
  application->OptimizeTNLP(program);
  EXPECT_FALSE(program->missed_an_entry());
  return told.str();
}

/// Displacements taken for those from the origin, as if the retraction were linear.
class LinearChart final : public TrajectoryChart {
 public:
  enum class Order { first, second };
  LinearChart(TrajectoryChart& chart, Order beyond) : chart_(chart), beyond_(beyond) {}
  const Transcription& transcription() const override { return chart_.transcription(); }
  void stand_at(const TrajectoryDisplacement& x) override { chart_.stand_at(x); }
  void retraction(long node, const double* v, Retraction out) const override {
    const int n = transcription().sizes().node;
    chart_.retraction(node, v, out);
    std::fill(out.second, out.second + n * n * n, 0.0);
    if (beyond_ == Order::second) return;
    std::fill(out.first, out.first + n * n, 0.0);
    for (int i = 0; i < n; ++i) out.first[i * n + i] = 1;
  }
  Range control_range(long stage, int control) const override { return chart_.control_range(stage, control); }
  int inequalities_before_bounds() const override { return chart_.inequalities_before_bounds(); }

 private:
  TrajectoryChart& chart_;
  Order beyond_;
};

constexpr const char* no_errors = "No errors detected by derivative checker.";

template <class Sys> void expect_derivatives(const ControlTask<Sys>& task) {
  TrajectoryChartOf<Sys> chart(task, control_guess(task, 4, 3));
  for (const auto blocks : {ControlProgram::Blocks::sparse, ControlProgram::Blocks::whole}) {
    const std::string told = told_of_derivatives(chart, blocks);
    EXPECT_NE(told.find(no_errors), std::string::npos) << told;
  }
}

ControlTask<DubinsCar> dubins() {
  ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, true};
  task.lower(0) = -2;
  task.upper(0) = 2;
  return task;
}

TEST(ProgramOfIpopt, HasTheDerivativesOfItsValues) {
  expect_derivatives(dubins());
  auto to_a_line = dubins();
  to_a_line.free_start = {true, false, false};
  to_a_line.free_end = {false, false, true};
  expect_derivatives(to_a_line);
  to_a_line.end_cost = node_condition<SE2, 1>(
      []<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(0, 2) * p(1, 2) + p(1, 0) * p(1, 0)); });
  expect_derivatives(to_a_line);
  auto through_a_gate = dubins();
  const auto gate = node_condition<SE2, 1>(
      []<class S>(const Matrix<S, 3, 3>& p) { return Vector<S, 1>(p(0, 2) + p(1, 2) * p(1, 2) - 2.5); });
  through_a_gate.phases.resize(3);
  for (auto& phase : through_a_gate.phases) {
    phase.stages = 2;
    phase.duration_is_free = true;
    phase.end_condition = gate;
    phase.lower(0) = -2;
  }
  through_a_gate.phases[0].shortest = 0.1;
  through_a_gate.phases[1].upper(0) = -2;  // fixed
  through_a_gate.phases[2].end_condition = nullptr;
  through_a_gate.phases[2].upper(0) = 2;
  expect_derivatives(through_a_gate);
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  using States = FlowStates<SatelliteTurn::GroupoidType>;
  States::State end;
  end << 0.4, 1.9, 0.2, 0, 0, 0;
  expect_derivatives<SatelliteTurn>({satellite, States::arrow(States::State::Zero(), end, satellite.avoided), 5});
}

void expect_derivatives_of_scene(SceneControl task) {
  task.duration_is_free = true;
  task.duration_weight = 1;
  task.stages = 3;
  ControlledScene scene(task);
  SceneChart chart(scene, scene_guess(scene, 3));
  const std::string told = told_of_derivatives(chart, ControlProgram::Blocks::sparse);
  EXPECT_NE(told.find(no_errors), std::string::npos) << told;
}

TEST(ProgramOfIpopt, HasTheDerivativesOfScenesOfBodies) {
  for (const Retraction rotation : {Retraction::exponential, Retraction::cayley}) {
    SceneControl satellite = control_of_scene(Satellite{rotation});
    satellite.actuators = {{"torque1"}, {"torque2", -1, 2}, {"torque3", -1}};
    satellite.cones = {{Satellite::of_body, {0, 0, 1}, {0.6, 0, 0.8}, 0.3, DirectionCone::Side::outside}};
    satellite.speed_limits = {{.attitude = Satellite::of_body, .most = 0.8}};
    satellite.end.turns = {{Satellite::of_body, {0.8, 0, 0.6, 0}}};
    expect_derivatives_of_scene(satellite);
  }
  SceneControl arm = control_of_scene(DampedArm{});
  arm.actuators = {{"shoulder"}, {"elbow", -HUGE_VAL, 1}};
  arm.keep_outs = {{Arm::of_fore, KeepOut::Kind::disk, {0.9, 0.9, 0}, 0.3}};
  arm.end.places = {{Arm::of_fore, 0, 0.3}, {Arm::of_fore, 1, 0.7}};
  expect_derivatives_of_scene(arm);
}

/// Controls are free up to 0.2, so that near the start the cost has no derivatives at all.
struct FreeAtFirst : ControlSystem<FreeAtFirst, Pair<1>, 1, 1> {
  template <class S> S cost(const Arrow<S>&, const Controls<S>& u, const S& h) const {
    const S over = u(0) - 0.2;
    return value_of(over) > 0 ? S(h * over * over) : S(0.0);
  }
  template <class S> Vector<S, 1> constraint(const Arrow<S>& g, const Controls<S>& u, const S& h) const {
    return Vector<S, 1>(g.target(0) - g.source(0) - h * u(0));
  }
};

TEST(ProgramOfIpopt, BeginsAgainWithWholeBlocksWhereAnEntryWasLeftOut) {
  const ControlTask<FreeAtFirst> task{{}, {Vector<double, 1>(0), Vector<double, 1>(1)}, 1};
  const ControlTrajectory<FreeAtFirst> start = straight_trajectory(task, 10);
  TrajectoryChartOf<FreeAtFirst> chart(task, start);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Initialize();
  const Ipopt::SmartPtr<ControlProgram> program = new ControlProgram(chart, ControlProgram::Blocks::sparse);
  application->OptimizeTNLP(program);
  EXPECT_TRUE(program->missed_an_entry());
  const auto found = solve_control_by_ipopt(task, start);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_NEAR(found.report.cost, 0.64, 1e-9);
}

TEST(BrokenChart, FailsTheTestOfItsDerivatives) {
  const auto task = dubins();
  TrajectoryChartOf<DubinsCar> chart(task, control_guess(task, 4, 3));
  for (const auto beyond : {LinearChart::Order::first, LinearChart::Order::second}) {
    LinearChart broken(chart, beyond);
    const std::string told = told_of_derivatives(broken, ControlProgram::Blocks::whole);
    EXPECT_EQ(told.find(no_errors), std::string::npos) << told;
    EXPECT_NE(told.find("Derivative checker detected"), std::string::npos) << told;
  }
}

}  // namespace
}  // namespace lagroid::optimal_control_ipopt_derivatives_tests
