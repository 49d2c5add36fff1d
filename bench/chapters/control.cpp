// Optimal control: whole solves by the framework and by IPOPT, of the same transcription, start and tolerance.
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/systems/control/flows/dubins_car.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>
#include <lagroid/systems/control/flows/swing_up.hpp>

#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace bench {

namespace {

using namespace lagroid;

constexpr const char* by_framework = "framework";
constexpr const char* with_crossover = "framework, with crossover";
constexpr const char* by_ipopt = "IPOPT";
constexpr long counts[] = {100, 1000, 10000};
constexpr double tolerance = 1e-10;

/// A problem from its straight trajectory, whatever its type.
struct ControlCase {
  std::string name;
  std::function<ControlReport(long stages, const ControlOptions&)> ours;
  std::function<ControlReport(long stages, const ControlOptions&)> theirs;

  std::string group(long stages) const { return fmt::format("optimal control, {}, N = {}", name, stages); }
  std::string iterations(long stages) const { return group(stages) + ", iterations"; }
  std::string of_a_stage() const { return fmt::format("optimal control, {}, an iteration for each stage", name); }
};

template <class Sys> ControlCase case_of(std::string name, const ControlTask<Sys>& task) {
  return {std::move(name),
          [task](long stages, const ControlOptions& options) {
            return solve_control(task, straight_trajectory(task, stages), options).report;
          },
          [task](long stages, const ControlOptions& options) {
            return solve_control_by_ipopt(task, straight_trajectory(task, stages), options).report;
          }};
}

std::vector<ControlCase> cases() {
  ControlTask<SwingUp> swing{{}, {{0, 0}, {std::numbers::pi, 0}}, 10};
  swing.lower(0) = -0.5;
  swing.upper(0) = 0.5;
  using Attitudes = FlowStates<SatelliteTurn::GroupoidType>;
  const Vector<double, 3> rotation = 2 * Vector<double, 3>(1, 2, 3).normalized();
  Attitudes::State end;
  end << rotation, 0, 0, 0;
  const SatelliteTurn satellite;
  ControlTask<SatelliteTurn> turn{satellite, Attitudes::arrow(Attitudes::State::Zero(), end, satellite.avoided), 5};
  turn.lower.setConstant(-0.5);
  turn.upper.setConstant(0.5);
  ControlTask<DubinsCar> way{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, std::numbers::pi / 3}), 5, true};
  way.lower(0) = -1;
  way.upper(0) = 1;
  return {case_of("swing-up with a bounded torque", swing), case_of("satellite with bounded torques", turn),
          case_of("Dubins' car, time free", way)};
}

ControlOptions options(bool crossover) {
  ControlOptions out;
  out.tolerance = tolerance;
  out.crossover = crossover;
  return out;
}

}  // namespace

std::vector<Subject> control_subjects() {
  std::vector<Subject> out;
  for (const ControlCase& each : cases())
    for (const long stages : counts) {
      const auto add = [&](const char* name, const auto& solve, bool crossover) {
        out.push_back({each.group(stages), name,
                       [solve, stages, crossover](benchmark::State& state) {
                         for (auto _ : state)
                           if (!solve(stages, options(crossover)).converged()) {
                             state.SkipWithError("not solved");
                             return;
                           }
                       },
                       name == by_framework});
      };
      add(by_framework, each.ours, false);
      add(with_crossover, each.ours, true);
      add(by_ipopt, each.theirs, false);
    }
  return out;
}

Results control_counts(const Results& times) {
  Results out;
  for (const ControlCase& each : cases())
    for (const long stages : counts) {
      if (!times.contains(key_of(each.group(stages), by_framework))) continue;
      const double ours = each.ours(stages, options(false)).iterations;
      const double theirs = each.theirs(stages, options(false)).iterations;
      out[key_of(each.iterations(stages), by_framework)].median = ours;
      out[key_of(each.iterations(stages), by_ipopt)].median = theirs;
      out[key_of(each.of_a_stage(), fmt::format("N = {}", stages))].median =
          times.at(key_of(each.group(stages), by_framework)).median / (ours * double(stages));
    }
  return out;
}

std::vector<Goal> control_goals() {
  std::vector<Goal> out;
  for (const ControlCase& each : cases()) {
    for (const long stages : counts) {
      out.push_back({each.group(stages), by_ipopt, by_framework, 10, /*at_least=*/true});
      out.push_back({each.iterations(stages), by_framework, by_ipopt, 1.5});
    }
    out.push_back({each.of_a_stage(), "N = 10000", "N = 100", 1.5});
  }
  return out;
}

std::string control_table(const Results& results) {
  std::string rows;
  for (const ControlCase& each : cases())
    for (const long stages : counts) {
      const auto ours = results.find(key_of(each.iterations(stages), by_framework));
      if (ours == results.end()) continue;
      rows += fmt::format("| {} | {} | {:.0f} | {:.0f} | {:.0f} ns |\n", each.name, stages, ours->second.median,
                          results.at(key_of(each.iterations(stages), by_ipopt)).median,
                          results.at(key_of(each.of_a_stage(), fmt::format("N = {}", stages))).median);
    }
  if (rows.empty()) return rows;
  return "| | N | iterations | by IPOPT | an iteration, for each stage |\n|---|---|---|---|---|\n" + rows;
}

}  // namespace bench
