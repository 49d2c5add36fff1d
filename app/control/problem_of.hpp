#pragma once
/// A ControlledFlow as a problem of scenes. It names its `states` and `control_names`, and FlowStates makes arrows of
/// them.

#include "../keys/parameter.hpp"
#include "../reading/kinds.hpp"
#include "control_scene.hpp"

#include <lagroid/solvers/processor_time.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

template <class Sys> class ControlProblemOf final : public ControlProblem {
 public:
  using G = typename Sys::GroupoidType;
  using States = FlowStates<G>;
  using State = typename States::State;

  /// A system of the library that is actuated has its own parameters.
  static constexpr bool is_actuated = requires(Sys sys) { sys.system; };
  static auto parametrised() {
    if constexpr (is_actuated) {
      return decltype(Sys::system)();
    } else {
      return Sys();
    }
  }
  using Parametrised = decltype(parametrised());

  ControlProblemOf(std::string_view name, std::string_view summary) : name_(name), summary_(summary) {}
  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }
  std::vector<std::string> states() const override { return {Sys::states.begin(), Sys::states.end()}; }
  std::vector<std::string> controls() const override { return {Sys::control_names.begin(), Sys::control_names.end()}; }
  std::vector<Key> parameters() const override { return parameter_keys<Parametrised>(); }

  ControlResult solve(const Section& scene, const std::function<bool(int)>& keep_going) const override {
    ControlTask<Sys> task;
    if constexpr (is_actuated) {
      task.system.system = read_parameters<Parametrised>(scene);
    } else {
      task.system = read_parameters<Parametrised>(scene);
    }
    const ControlScene read = read_control_scene(scene, states(), controls());
    scene.finish();
    const State start = Eigen::Map<const State>(read.start.data());
    const State end = Eigen::Map<const State>(read.end.data());
    task.boundary = arrow(task.system, start, end);
    task.duration = read.duration;
    task.duration_is_free = read.duration_is_free;
    for (int i = 0; i < Sys::controls; ++i) {
      task.lower(i) = read.bounds[std::size_t(i)].first;
      task.upper(i) = read.bounds[std::size_t(i)].second;
    }
    const double before = processor_time();
    const ControlSearch<Sys> found = search_control(task, read.stages, read.search, keep_going);
    ControlResult out = described(task.system.groupoid, start, found);
    out.seconds = processor_time() - before;
    out.lower.assign(task.lower.begin(), task.lower.end());
    out.upper.assign(task.upper.begin(), task.upper.end());
    return out;
  }

 private:
  static ArrowOf<G> arrow(const Sys& system, const State& start, const State& end) {
    if constexpr (requires { system.avoided; }) {
      return States::arrow(start, end, system.avoided);
    } else {
      return States::arrow(start, end);
    }
  }

  ControlResult described(const G& groupoid, const State& start, const ControlSearch<Sys>& found) const {
    const ControlSolution<Sys>& best = found.minima.empty() ? found.best_failure : found.minima.front();
    ControlResult out;
    out.problem = name_;
    out.groupoid = G::name();
    out.states = states();
    out.controls = controls();
    out.report = best.report;
    out.outcomes = found.outcomes;
    out.iterations = found.iterations;
    for (const auto& each : found.minima) out.costs.push_back(each.report.cost);
    ArrowOf<G> reached = groupoid.unit(groupoid.source(best.trajectory.arrows.front()));
    const auto row = [&](std::size_t node) {
      const State state = States::reached(start, reached);
      out.times.push_back(double(node) * best.trajectory.step);
      out.state_rows.emplace_back(state.begin(), state.end());
    };
    row(0);
    for (std::size_t k = 0; k < best.trajectory.arrows.size(); ++k) {
      reached = groupoid.compose(reached, best.trajectory.arrows[k]);
      row(k + 1);
      const auto& u = best.trajectory.controls[k];
      out.control_rows.emplace_back(u.begin(), u.end());
    }
    out.costate_rows = best.costates;
    out.inequality_rows = best.inequality_multipliers;
    return out;
  }

  std::string_view name_;
  std::string_view summary_;
};

}  // namespace lagroid::app
