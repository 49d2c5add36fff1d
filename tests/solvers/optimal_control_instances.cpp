// Instances that are feasible by construction: from a state drawn at random, where random admissible controls lead.
#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/systems/control/flows/double_integrator.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/hovercraft.hpp>
#include <lagroid/systems/control/flows/low_thrust.hpp>
#include <lagroid/systems/control/flows/planar_mass.hpp>
#include <lagroid/systems/control/flows/reeds_shepp_car.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/control/flows/steered_car.hpp>
#include <lagroid/systems/control/flows/steered_sleigh.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace lagroid::solvers_optimal_control_instances_tests {
namespace {

constexpr long stages = 50;
constexpr int starts = 10;  // those of `search_control`

template <class Sys> class Instances {
 public:
  using G = typename Sys::GroupoidType;
  using States = FlowStates<G>;
  using State = typename States::State;

  Instances(const Sys& system, double duration, double bound, double spread)
      : system_(system), duration_(duration), bound_(bound), normal_(0, spread) {}
  State& around() { return around_; }
  /// The controls are bounded by an inequality of the system's own.
  void leave_out_bounds() { has_bounds_ = false; }

  void let_time_be_free() { time_is_free_ = true; }

  /// The next whose own inequalities hold on the way.
  ControlTask<Sys> next() {
    for (;;)
      if (const auto task = drawn()) return *task;
  }

 private:
  std::optional<ControlTask<Sys>> drawn() {
    const G& groupoid = system_.groupoid;
    const double h = duration_ / double(stages);
    std::uniform_real_distribution<double> admissible(-0.9 * bound_, 0.9 * bound_);
    Eigen::Matrix<double, Sys::controls, 5> knots;
    for (double& x : knots.reshaped()) x = admissible(generator_);
    State start = around_;
    for (double& x : start) x += normal_(generator_);
    ArrowOf<G> reached = unit(start);
    for (long k = 0; k < stages; ++k) {
      const double t = 4 * (double(k) + 0.5) / double(stages);
      const int knot = std::min(3, int(t));
      const Vector<double, Sys::controls> u = (knot + 1 - t) * knots.col(knot) + (t - knot) * knots.col(knot + 1);
      const auto q = groupoid.target(reached);
      Vector<double, G::dimension> v = Vector<double, G::dimension>::Zero();
      for (int i = 0; i < 100; ++i)  // the midpoint rule contracts
        v = h * system_.flow(detail::moved_object(groupoid, q, Vector<double, G::dimension>(0.5 * v)), u);
      const ArrowOf<G> g = groupoid.tau(q, v);
      if constexpr (Sys::inequalities > 0)
        if (system_.inequality(g, u, h).maxCoeff() > -0.01) return std::nullopt;
      reached = groupoid.compose(reached, g);
    }
    ControlTask<Sys> task{system_, reached, duration_, time_is_free_};
    if (has_bounds_) {
      task.lower.setConstant(-bound_);
      task.upper.setConstant(bound_);
    }
    return task;
  }
  ArrowOf<G> unit(const State& state) const {
    if constexpr (requires { system_.avoided; }) {
      return States::arrow(state, state, system_.avoided);
    } else {
      return States::arrow(state, state);
    }
  }

  Sys system_;
  double duration_;
  double bound_;
  std::normal_distribution<double> normal_;
  State around_ = State::Zero();
  bool has_bounds_ = true;
  bool time_is_free_ = false;
  std::mt19937 generator_{7};
};

/// At least 95 % of them are solved from one of the starts; the others end with a type.
template <class Sys> void expect_solved(Instances<Sys> instances) {
  constexpr int count = 200;
  std::map<std::string, int> failed;
  std::vector<int> iterations;
  int at_once = 0;
  for (int i = 0; i < count; ++i) {
    const ControlTask<Sys> task = instances.next();
    ControlReport report;
    for (int start = 0; start < starts && !report.converged(); ++start) {
      report = solve_control(task, control_guess(task, stages, start), {.max_iterations = 150}).report;
      if (start == 0) at_once += report.converged() ? 1 : 0;
    }
    EXPECT_NE(report.status, ControlStatus::not_finite);
    if (report.converged())
      iterations.push_back(report.iterations);
    else
      ++failed[std::string(to_string(report.status))];
  }
  EXPECT_GE(double(iterations.size()), 0.95 * count);
  // What docs/optimal_control_measured.md says.
  std::sort(iterations.begin(), iterations.end());
  testing::Test::RecordProperty("instances", count);
  testing::Test::RecordProperty("solved", int(iterations.size()));
  testing::Test::RecordProperty("at_once", at_once);
  testing::Test::RecordProperty("iterations", iterations.empty() ? 0 : iterations[iterations.size() / 2]);
  for (const auto& [status, times] : failed) testing::Test::RecordProperty("ended " + status, times);
}

TEST(RandomInstances, OfTheDoubleIntegrator) { expect_solved(Instances(DoubleIntegrator(), 2, 1, 0.5)); }
TEST(RandomInstances, OfThePendulum) { expect_solved(Instances(SwingUp(), 4, 0.8, 0.5)); }
TEST(RandomInstances, OfThePlanarMass) { expect_solved(Instances(PlanarMass(), 3, 1, 1)); }
TEST(RandomInstances, OfTheHovercraft) { expect_solved(Instances(Hovercraft(), 3, 1, 0.3)); }
TEST(RandomInstances, OfTheCar) { expect_solved(Instances(SteeredCar(), 3, 0.7, 0.3)); }
TEST(RandomInstances, OfTheSleigh) { expect_solved(Instances(SteeredSleigh(), 3, 1, 0.3)); }
TEST(RandomInstances, OfCarsOfDubins) {
  Instances<DubinsCar> ways(DubinsCar(), 4, 1, 1);
  ways.let_time_be_free();
  expect_solved(ways);
}
TEST(RandomInstances, OfCarsOfReedsAndShepp) {
  Instances<ReedsSheppCar> ways(ReedsSheppCar(), 4, 1, 1);
  ways.let_time_be_free();
  expect_solved(ways);
}
TEST(RandomInstances, OfTransfers) {
  LowThrust craft;
  craft.largest_thrust = 0.05;
  Instances<LowThrust> transfers(craft, 4, 0.035, 0.05);
  transfers.around() << 1, 0, 0, 1;
  transfers.leave_out_bounds();
  expect_solved(transfers);
}
TEST(RandomInstances, OfTheSatellite) { expect_solved(Instances(SatelliteTurn(), 4, 0.5, 0.4)); }
TEST(RandomInstances, OfTheSatelliteBesideACone) {
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  expect_solved(Instances(satellite, 4, 0.5, 0.4));
}

}  // namespace
}  // namespace lagroid::solvers_optimal_control_instances_tests
