#pragma once
/// A ControlledFlow as a problem of scenes. It names its `states` and `control_names`, and FlowStates makes arrows of
/// them.

#include "../keys/parameter.hpp"
#include "../reading/kinds.hpp"
#include "../scenes/arrow_format.hpp"
#include "control_scene.hpp"
#include "problems/loop_of.hpp"
#include "problems/states_of_problem.hpp"

#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/control/testing/control_solution_laws.hpp>
#include <lagroid/solvers/processor_time.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::app {

template <class Sys> class ControlProblemOf final : public ControlProblem {
 public:
  using G = typename Sys::GroupoidType;
  using States = FlowStates<G>;
  using State = typename States::State;
  using Condition = StateCondition<G>;

  /// What has the parameters: of a system of the library that is actuated that system.
  static auto& parametrised_of(Sys& sys) {
    if constexpr (requires { sys.system; }) {
      return sys.system;
    } else {
      return sys;
    }
  }
  using Parametrised = std::remove_reference_t<decltype(parametrised_of(std::declval<Sys&>()))>;

  /// What each inequality is called: one that may be of states by the parameter that sets it.
  using Limits = std::array<std::string_view, std::size_t(Sys::inequalities)>;
  /// What it looks like in space, by columns of its states and, of an attitude, `attitude_columns`.
  using Shapes = std::vector<Shape> (*)(const Sys&);

  ControlProblemOf(std::string_view name, std::string_view summary,
                   Shapes shapes = nullptr) requires(Sys::inequalities == 0)
      : name_(name), summary_(summary), shapes_(shapes) {}
  ControlProblemOf(std::string_view name, std::string_view summary, const Limits& limits, Shapes shapes = nullptr)
      : name_(name), summary_(summary), limits_(limits), shapes_(shapes) {}
  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }
  std::vector<std::string> states() const override { return {Sys::states.begin(), Sys::states.end()}; }
  std::vector<std::string> controls() const override { return {Sys::control_names.begin(), Sys::control_names.end()}; }
  std::vector<Key> parameters() const override { return parameter_keys<Parametrised>(); }

  ControlResult solve(const Section& scene, const std::function<bool(int)>& keep_going) const override {
    const Posed posed = read(scene);
    const double before = processor_time();
    ControlResult out;
    if (posed.scene.loop) {
      const State start = start_of(posed.scene);
      const ControlSearch<Sys> found = search(posed, keep_going);
      LoopOf<Sys> loop(posed.task, posed.scene, best_of(found));
      out = close_loop(*this, loop, *posed.scene.loop, {start.begin(), start.end()}, keep_going);
      out.groupoid = G::name();
      out.outcomes = found.outcomes;
      out.iterations += found.iterations;
    } else {
      const ControlSearch<Sys> found = search(posed, keep_going);
      require_time(scene, posed, best_of(found));
      out = described(posed, found);
    }
    out.seconds = processor_time() - before;
    name_numbers(posed, out);
    out.lower.assign(posed.task.lower.begin(), posed.task.lower.end());
    out.upper.assign(posed.task.upper.begin(), posed.task.upper.end());
    return out;
  }
  Certificate certify(const Section& scene, int samples, std::uint64_t seed) const override {
    const Posed posed = read(scene);
    const ControlSearch<Sys> found = search(posed, [](int) { return true; });
    Certificate out;
    out.system = name_;
    out.groupoid = G::name();
    out.samples = samples;
    out.seed = long(seed);
    TranscriptionOf<Sys> bent(posed.task, control_guess(posed.task, 10, 3, posed.scene.search));
    out.suites.push_back(laws::transcription_laws(bent, std::min(samples, 20), seed));
    const ControlSolution<Sys>& best = best_of(found);
    out.states = best.trajectory.arrows.size() + 1;
    if (best.report.converged()) {
      out.suites.push_back(laws::control_solution_laws(posed.task, best, posed.scene.search.solver, samples, seed));
    } else {
      out.failure = best.report.message;
      out.failure_status = to_string(best.report.status);
    }
    return out;
  }
  std::unique_ptr<SceneLoop> loop(const Section& scene, const std::function<bool(int)>& keep_going) const override {
    const Posed posed = read(scene);
    require_loop(scene);
    require_loop_scene(scene, posed.scene);
    return std::make_unique<LoopOf<Sys>>(posed.task, posed.scene, best_of(search(posed, keep_going)));
  }

 private:
  /// What a scene asks for.
  struct Posed {
    ControlTask<Sys> task;
    ControlScene scene;
  };
  Posed read(const Section& scene) const {
    Posed posed;
    ControlTask<Sys>& task = posed.task;
    parametrised_of(task.system) = read_parameters<Parametrised>(scene);
    posed.scene = read_control_scene(scene, states(), controls());
    const ControlScene& read = posed.scene;
    task.boundary = arrow_between(task.system, start_of(read), end_of(read));
    if constexpr (requires { Sys::conserved; }) {
      task.free_end = Sys::conserved;
      for (std::size_t i = 0; i < read.start.size(); ++i)
        if (Sys::conserved[i] && read.start[i] != read.end[i])
          scene.fail("boundary", std::string(Sys::states[i]) +
                                     " is conserved, whatever the controls; give the end that of the start");
    }
    task.duration = read.duration;
    task.duration_is_free = read.duration_is_free;
    set_bounds(task, read.bounds);
    set_weights(task.system, read.weights);
    pose_ends(scene, posed);
    for (const PhaseScene& phase : read.phases) task.phases.push_back(posed_phase(posed, phase));
    scene.finish();
    if (read.loop) require_loop(scene);
    require_end(scene, posed, Ends::start);
    require_end(scene, posed, Ends::end);
    return posed;
  }
  /// A loop begins anew at each state, from where an end with another momentum is out of reach.
  static void require_loop(const Section& scene) {
    if constexpr (requires { Sys::conserved; }) {
      const auto first = std::find(Sys::conserved.begin(), Sys::conserved.end(), true);
      scene.fail(std::string(keys::control),
                 fmt::format("a loop is between states that are given, and {} is conserved, whatever the controls; "
                             "solve it without [loop]",
                             Sys::states[std::size_t(first - Sys::conserved.begin())]));
    }
  }
  /// Where the scene has the duration of a phase.
  static Section table_of_duration(const Section& scene, const Posed& posed, std::size_t phase) {
    return posed.scene.phases.empty() ? scene.section("horizon", "") : posed.scene.phases[phase].table;
  }
  enum class Ends { start, end };
  /// What is wrong with an end, before anything is solved: an inequality that does not hold there, or that the motion
  /// can wait there for as long as it likes.
  void require_end(const Section& scene, const Posed& posed, Ends which) const {
    const bool at_start = which == Ends::start;
    const char* const key = at_start ? "start" : "end";
    const ControlTask<Sys>& task = posed.task;
    const std::vector<bool>& free = at_start ? posed.scene.free_start : posed.scene.free_end;
    if (is_any(free)) return;
    const std::vector<ControlPhase<Sys>> phases = phases_of(task, posed.scene.stages);
    const ControlPhase<Sys>& phase = at_start ? phases.front() : phases.back();
    const G& groupoid = phase.system.groupoid;
    const auto node = at_start ? groupoid.source(task.boundary) : groupoid.target(task.boundary);
    if constexpr (Sys::inequalities > 0)
      if (const auto broken = phase.inequalities_hold ? broken_at(phase.system, node) : std::nullopt)
        scene.section("boundary", "")
            .fail(key, fmt::format(
                           "what parameters.{} asks for does not hold there; give a state where it does, or change it",
                           limits_[*broken]));
    if (!phase.duration_is_free || std::isfinite(phase.longest) || !can_wait(phase, node)) return;
    const std::vector<Key> keys = parameters();
    const bool has_cost = std::any_of(keys.begin(), keys.end(), [](const Key& each) { return each.name == "cost"; });
    const bool in_phases = !posed.scene.phases.empty();
    const Section table = table_of_duration(scene, posed, at_start ? 0 : phases.size() - 1);
    table.fail("free",
               fmt::format("the motion can wait at its {} at no cost, so that no duration is the best: {}{}", key,
                           has_cost ? "let time be the cost (parameters.cost = \"time\"), or a part of it "
                                      "beside the controls ([weights]), or "
                                    : "",
                           in_phases ? "give the duration a range" : "leave out free"));
  }
  static bool comes_back(const Posed& posed) {
    return posed.task.system.groupoid.tau_inverse(posed.task.boundary).isZero(1e-12);
  }
  /// The first phase in which nothing moves, of those whose durations are free.
  static std::optional<std::size_t> standing_phase(const Posed& posed, const ControlTrajectory<Sys>& found) {
    constexpr double nothing = 1e-6;
    const std::vector<ControlPhase<Sys>> phases = phases_of(posed.task, posed.scene.stages);
    auto arrow = found.arrows.begin();
    for (std::size_t i = 0; i < phases.size() && i < found.phases.size(); ++i) {
      double way = 0;
      for (long k = 0; k < phases[i].stages; ++k) way += posed.task.system.groupoid.tau_inverse(*arrow++).norm();
      if (phases[i].duration_is_free && way <= nothing) return i;
    }
    return std::nullopt;
  }
  static bool is_much_shorter_than_guessed(const ControlPhase<Sys>& phase, const PhaseSteps& found) {
    constexpr double much = 1e-3;
    return phase.duration_is_free && found.step * double(phase.stages) <= much * phase.duration;
  }
  /// Of motions that come back to their start none is the shortest: where there are others, these are meant.
  static void leave_out_none(const Posed& posed, ControlSearch<Sys>& found) {
    if (!comes_back(posed)) return;
    const auto is_none = [&](const ControlSolution<Sys>& each) {
      return standing_phase(posed, each.trajectory).has_value();
    };
    if (!std::all_of(found.minima.begin(), found.minima.end(), is_none)) std::erase_if(found.minima, is_none);
  }
  /// Whether a motion in half of the free durations costs less.
  static bool has_a_faster_one(const Posed& posed, const ControlSolution<Sys>& found) {
    ControlTask<Sys> task = posed.task;
    task.phases = phases_of(task, posed.scene.stages);
    ControlTrajectory<Sys> path = found.trajectory;
    for (std::size_t i = 0; i < task.phases.size(); ++i) {
      ControlPhase<Sys>& phase = task.phases[i];
      if (std::exchange(phase.duration_is_free, false)) path.phases[i].step /= 2;
      phase.duration = path.phases[i].step * double(phase.stages);
    }
    const ControlReport faster = solve_control(task, std::move(path), posed.scene.search.solver).report;
    return faster.converged() && faster.cost < found.report.cost;
  }
  /// Refuses a free duration that went to nothing, where it can be told why.
  static void require_time(const Section& scene, const Posed& posed, const ControlSolution<Sys>& found) {
    const std::vector<ControlPhase<Sys>> phases = phases_of(posed.task, posed.scene.stages);
    const ControlTrajectory<Sys>& path = found.trajectory;
    for (std::size_t i = 0; i < phases.size() && i < path.phases.size(); ++i)
      if (is_much_shorter_than_guessed(phases[i], path.phases[i]) &&
          has_unbounded_control(phases[i], posed.task.boundary) &&
          (!found.report.converged() || has_a_faster_one(posed, found)))
        table_of_duration(scene, posed, i)
            .fail("free",
                  "a control that costs nothing and has not both bounds makes the duration as short as one likes: give "
                  "them, or leave out free");
    const std::optional<std::size_t> standing = standing_phase(posed, path);
    if (!standing) return;
    const Section table = table_of_duration(scene, posed, *standing);
    if (found.report.converged() && is_any(posed.scene.free_end))
      table.fail("free",
                 "no motion to the end, which is free, is cheaper than none: leave out free, or change what costs");
    if (comes_back(posed))
      table.fail("free",
                 "the end is the start, so that the shortest motion is none: leave out free, or give [[phase]] "
                 "a range or a state on the way");
  }
  /// What a solve that failed says of a free duration that was guessed much too long.
  static std::string too_long_a_guess(const Posed& posed, const ControlTrajectory<Sys>& found) {
    const std::vector<ControlPhase<Sys>> phases = phases_of(posed.task, posed.scene.stages);
    for (std::size_t i = 0; i < phases.size() && i < found.phases.size(); ++i)
      if (is_much_shorter_than_guessed(phases[i], found.phases[i]))
        return fmt::format("; a free duration came to {:.3g} from the guess of {}: guess it nearer to what it may be",
                           found.phases[i].step * double(phases[i].stages), phases[i].duration);
    return "";
  }
  template <class Bounded> static void set_bounds(Bounded& of, const ControlBounds& bounds) {
    for (int i = 0; i < int(bounds.size()); ++i) std::tie(of.lower(i), of.upper(i)) = bounds[std::size_t(i)];
  }
  static void set_weights(Sys& system, const std::optional<WeightsScene>& weights) {
    if (!weights) return;
    auto& of = system.weights.emplace();
    of.of_controls = Eigen::Map<const decltype(of.of_controls)>(weights->of_controls.data());
    of.of_time = weights->of_time;
  }
  /// An attitude is free as a whole or not at all: one number of a rotation vector means nothing by itself.
  template <class Fail> static void require_whole_attitudes(const std::vector<bool>& free, const Fail& fail) {
    for (int i = 1; i < States::size; ++i)
      if (States::is_attitude(i) && States::is_attitude(i - 1) && free[std::size_t(i)] != free[std::size_t(i - 1)])
        fail("an attitude is given by all three of its numbers, or free in all");
  }
  /// Ends that are free in part: every displacement is, and what is given are conditions.
  static void pose_ends(const Section& scene, Posed& posed) {
    const ControlScene& read = posed.scene;
    ControlTask<Sys>& task = posed.task;
    const State start = start_of(read);
    const auto pose = [&](const char* key, const std::vector<bool>& free, const State& at, const auto& on, auto& along,
                          auto& condition) {
      if (!is_any(free)) return;
      require_whole_attitudes(free, [&](const char* why) { scene.section("boundary", "").fail(key, why); });
      typename Condition::Given given{};
      bool any = on != nullptr;
      for (std::size_t i = 0; i < given.size(); ++i) {
        given[i] = !free[i] && !is_conserved(i);
        any = any || given[i];
      }
      along.fill(true);
      if (any) condition = std::make_shared<const Condition>(start, at, given, on);
    };
    pose("free_start", read.free_start, start, read.start_on, task.free_start, task.start_condition);
    pose("free_end", read.free_end, end_of(read), read.end_on, task.free_end, task.end_condition);
    if (read.end_cost)
      task.end_cost =
          std::make_shared<const Condition>(start, end_of(read), typename Condition::Given{}, read.end_cost);
  }
  static bool is_conserved(std::size_t i) {
    if constexpr (requires { Sys::conserved; }) {
      return Sys::conserved[i];
    } else {
      return false;
    }
  }
  static ControlPhase<Sys> posed_phase(const Posed& posed, const PhaseScene& read) {
    ControlPhase<Sys> phase;
    phase.system = posed.task.system;
    phase.stages = read.stages;
    phase.duration = read.duration;
    phase.duration_is_free = read.duration_is_free;
    phase.shortest = read.shortest;
    phase.longest = read.longest;
    parametrised_of(phase.system) = with_parameters(read.table, parametrised_of(phase.system));
    set_bounds(phase, read.bounds);
    set_weights(phase.system, read.weights);
    phase.inequalities_hold = read.constraints_hold;
    // Where it might end: what is free there, in the share of the time that has passed.
    double before = 0;
    double all = 0;
    for (const PhaseScene& each : posed.scene.phases) {
      all += each.duration;
      if (&each <= &read) before += each.duration;
    }
    const State start = start_of(posed.scene);
    State at = start + before / all * (end_of(posed.scene) - start);
    typename Condition::Given given{};
    std::vector<bool> free(given.size(), true);
    bool any = false;
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (!read.through[i]) continue;
      any = given[i] = true;
      free[i] = false;
      at(int(i)) = *read.through[i];
    }
    require_whole_attitudes(free, [&](const char* why) { read.table.fail("through", why); });
    if (any) phase.guess = arrow_between(posed.task.system, start, at);
    if (any || read.on) phase.end_condition = std::make_shared<const Condition>(start, at, given, read.on);
    return phase;
  }
  /// With those of [phase.parameters].
  static Parametrised with_parameters(const Section& phase, Parametrised system) {
    const Section parameters = phase.section_or_empty("parameters");
    for_each_parameter<Parametrised>([&](auto p) {
      if constexpr (requires { p.required; }) p.required = false;
      reading::read(parameters, p, system);
    });
    if (const auto refusal = refusal_of(system)) reading::blame(parameters, *refusal);
    return system;
  }
  static State start_of(const ControlScene& scene) { return Eigen::Map<const State>(scene.start.data()); }
  static State end_of(const ControlScene& scene) { return Eigen::Map<const State>(scene.end.data()); }
  static ControlSearch<Sys> search(const Posed& posed, const std::function<bool(int)>& keep_going) {
    const ControlScene& scene = posed.scene;
    ControlSearch<Sys> found =
        scene.method == ControlMethod::interior_point
            ? search_control(posed.task, scene.stages, scene.search, keep_going)
            : search_control(posed.task, scene.stages, scene.search, keep_going,
                             [](const auto&... with) { return solve_control_by_ipopt(with...); });
    leave_out_none(posed, found);
    return found;
  }
  static const ControlSolution<Sys>& best_of(const ControlSearch<Sys>& found) {
    return found.minima.empty() ? found.best_failure : found.minima.front();
  }

  ControlResult described(const Posed& posed, const ControlSearch<Sys>& found) const {
    const G& groupoid = posed.task.system.groupoid;
    const State start = start_of(posed.scene);
    const ControlSolution<Sys>& best = best_of(found);
    ControlResult out;
    out.problem = name_;
    out.groupoid = G::name();
    out.states = states();
    out.controls = controls();
    out.by_ipopt = posed.scene.method == ControlMethod::ipopt;
    out.report = best.report;
    if (!best.report.converged()) {
      out.report.message += too_long_a_guess(posed, best.trajectory);
      if (posed.task.end_cost) out.report.message += "; or does boundary.end_cost fall without end?";
    }
    out.crossover = best.crossover;
    out.outcomes = found.outcomes;
    out.iterations = found.iterations;
    for (const auto& each : found.minima) out.costs.push_back(each.report.cost);
    ArrowOf<G> reached = groupoid.unit(groupoid.source(best.trajectory.arrows.front()));
    if (best.trajectory.start) reached = *best.trajectory.start;
    for (std::size_t p = 0; p < posed.scene.phases.size(); ++p) {
      const ControlPhase<Sys>& phase = posed.task.phases[p];
      const PhaseSteps& steps = best.trajectory.phases[p];
      out.phases.push_back({posed.scene.phases[p].name,
                            steps.stages,
                            double(steps.stages) * steps.step,
                            {phase.lower.begin(), phase.lower.end()},
                            {phase.upper.begin(), phase.upper.end()}});
    }
    const auto row = [&](std::size_t node) {
      const State state = States::reached(start, reached);
      out.times.push_back(best.trajectory.time(long(node)));
      out.state_rows.emplace_back(state.begin(), state.end());
    };
    row(0);
    for (std::size_t k = 0; k < best.trajectory.arrows.size(); ++k) {
      reached = groupoid.compose(reached, best.trajectory.arrows[k]);
      row(k + 1);
      const auto& u = best.trajectory.controls[k];
      out.control_rows.emplace_back(u.begin(), u.end());
    }
    if (const auto& of_end = posed.scene.end_cost)
      of_end->values(out.state_rows.back().data(), &out.end_cost.emplace());
    out.costate_rows = best.costates;
    out.inequality_rows = best.inequality_multipliers;
    return out;
  }

  /// Names, units and what is seen.
  void name_numbers(const Posed& posed, ControlResult& out) const {
    out.state_units = {Sys::state_units.begin(), Sys::state_units.end()};
    out.control_units = {Sys::control_units.begin(), Sys::control_units.end()};
    out.equations = equation_names<Sys>();
    const std::vector<ControlPhase<Sys>> phases = phases_of(posed.task, posed.scene.stages);
    out.cost_unit = cost_unit_of(phases.front().system);
    for (const auto& phase : phases)
      if (cost_unit_of(phase.system) != out.cost_unit) out.cost_unit = "cost";
    out.inequalities.assign(limits_.begin(), limits_.end());
    for (const auto& each : duration_bounds_of(phases))
      out.inequalities.emplace_back(each.sign > 0 ? "longest duration" : "shortest duration");
    for (const auto& each : control_bounds_of(phases))
      out.inequalities.push_back(fmt::format("{} bound of {}", each.sign > 0 ? "upper" : "lower",
                                             Sys::control_names[std::size_t(each.control)]));
    name_conditions(posed, phases, out);
    if (shapes_ != nullptr) out.shapes = shapes_(posed.task.system);
    see_attitude(out);
  }
  static void name_conditions(const Posed& posed, const std::vector<ControlPhase<Sys>>& phases, ControlResult& out) {
    static_assert(Sys::node_equalities == 0 && Sys::end_equalities == 0, "conditions of a system's own are not named");
    long stages = 0;
    for (const auto& phase : phases) stages += phase.stages;
    out.conditions.resize(std::size_t(stages));
    const auto add = [&](const std::shared_ptr<const NodeCondition<G>>& condition, long stage,
                         const std::string& where) {
      if (!condition) return;
      for (const std::string& each : static_cast<const Condition&>(*condition).words(Sys::states))
        out.conditions[std::size_t(stage)].push_back(each + where);
    };
    add(posed.task.start_condition, 0, " at the start");
    long end = 0;
    for (std::size_t p = 0; p < phases.size(); ++p) {
      end += phases[p].stages;
      if (phases[p].end_condition)
        add(phases[p].end_condition, end - 1, fmt::format(" where the phase \"{}\" ends", posed.scene.phases[p].name));
    }
    add(posed.task.end_condition, stages - 1, " at the end");
  }
  /// The quaternion of a rotation vector among the states.
  static void see_attitude(ControlResult& out) {
    for (int i = 0; i < States::size; ++i) {
      if (!States::is_attitude(i)) continue;
      Columns attitude{
          "attitude", attitude_columns, "1", "rotation A from body to space, unit quaternion w, x, y, z", false, {}};
      for (const std::vector<double>& state : out.state_rows) {
        const auto q = quaternion_of(SO3::exp(Vector<double, 3>(state.data() + i)));
        attitude.values.insert(attitude.values.end(), q.begin(), q.end());
      }
      out.seen.push_back(std::move(attitude));
      return;
    }
  }

  std::string_view name_;
  std::string_view summary_;
  Limits limits_{};
  Shapes shapes_ = nullptr;
};

}  // namespace lagroid::app
