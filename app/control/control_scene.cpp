#include "control_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid::app {

namespace {

const KeyOf<Whole> samples_key{"samples", {1, 100'000'000}, "", "how often the problem is solved anew"};
const KeyOf<Number> disturbance_key{"disturbance",
                                    {nonnegative},
                                    "",
                                    "standard deviation of what chance adds to each number of a state, at each sample",
                                    LoopScene().disturbance};
const KeyOf<Whole> loop_iterations_key{"iterations",
                                       {1, 1'000'000},
                                       "",
                                       "of a sample, at most; 1 is the real-time iteration",
                                       long(LoopScene().iterations)};
const KeyOf<Number> loop_tolerance_key{
    "tolerance", {a_tolerance}, "", "on every part of a sample's KKT residual", LoopScene().tolerance};
const KeyOf<Number> usable_key{"usable",
                               {nonnegative},
                               "",
                               "a plan that did not converge is followed where its constraints are violated by no more",
                               LoopScene().usable};

KeyOf<NumberArray> end_key(const std::string& name, std::span<const std::string> states) {
  return {name, {states.size()}, "", fmt::format("{} of the {}", fmt::join(states, ", "), name)};
}

KeyOf<Either> bound_key(const std::string& control) {
  return range_key(control, "", "least and largest value; the same number twice fixes it");
}

/// "free_start" or "free_end".
KeyOf<Texts> free_end_key(const std::string& end) {
  return {"free_" + end, {}, "", fmt::format("names of what may differ from the {}", end), std::vector<std::string>()};
}
/// "start_on" or "end_on".
KeyOf<Texts> on_key(const std::string& name) {
  return {name, {}, "", "formulas of the state that vanish there", std::vector<std::string>()};
}

const KeyOf<Text> end_cost_key{"end_cost", {},    "", "formula of the state at an end that is free, added to the cost",
                               {},         "none"};

namespace phase_keys {

const KeyOf<Text> name{"name", {}, "", "what it is called", {}, "phase 1, phase 2 and so on"};
const KeyOf<Number> duration{"duration", {positive}, "s", "of it; where it is free, the first guess"};
const KeyOf<Flag> free{"free", {}, "", "true: the duration is an unknown", false};
const KeyOf<Either> range = range_key("range", "s", "shortest and longest duration, where it is free", nonnegative);
const KeyOf<Whole> stages{"stages", {1, 1'000'000}, "", "arrows of it", 50L};
const KeyOf<Flag> constraints{"constraints", {}, "", "false: those of the problem do not hold in it", true};

KeyOf<Number> through(const std::string& state) { return {state, {}, "", "what it is there", {}, "free"}; }

}  // namespace phase_keys

ControlBounds read_bounds(const Section& bounds, std::span<const std::string> controls,
                          const ControlBounds& otherwise) {
  ControlBounds out = otherwise;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    constexpr double none = std::numeric_limits<double>::infinity();
    if (!bounds.has(controls[i])) continue;
    out[i] = read_range(bounds, controls[i], any_number, {-none, none});
    if (!(out[i].first <= out[i].second))
      bounds.fail(controls[i],
                  fmt::format("{} is not below {}; give the lower bound first", out[i].first, out[i].second));
  }
  return out;
}

const KeyOf<Number> weight_of_time_key{"time", {nonnegative}, "", "w of w T", 0.0};
KeyOf<Number> weight_of_control_key(const std::string& control) {
  return {control, {nonnegative}, "", "w of the integral of w u^2", 0.0};
}

/// A table [weights] of a scene, or of a phase of it.
std::optional<WeightsScene> read_weights(const Section& at, std::span<const std::string> controls, bool must_cost) {
  if (!at.has("weights")) return std::nullopt;
  const Section table = at.section("weights", "");
  WeightsScene out;
  double sum = out.of_time = read_key(table, weight_of_time_key);
  for (const std::string& control : controls)
    sum += out.of_controls.emplace_back(read_key(table, weight_of_control_key(control)));
  table.finish();
  if (must_cost && !(sum > 0))
    table.fail("", fmt::format("nothing costs: give one of {} or time a weight", fmt::join(controls, ", ")));
  if (at.section_or_empty("parameters").has("cost"))
    at.fail("weights", "says what the motion costs: leave out parameters.cost, or weights");
  return out;
}

/// Which of the names a list of them has.
std::vector<bool> read_names(const Section& at, const KeyOf<Texts>& key, std::span<const std::string> names) {
  std::vector<bool> out(names.size());
  for (const std::string& each : read_key(at, key)) {
    const auto found = std::find(names.begin(), names.end(), each);
    if (found == names.end())
      at.fail(key.name, fmt::format("\"{}\" is no number of the state; they are {}", each, fmt::join(names, ", ")));
    const auto i = std::size_t(found - names.begin());
    if (out[i]) at.fail(key.name, fmt::format("\"{}\" stands there twice", each));
    out[i] = true;
  }
  return out;
}

std::shared_ptr<const StateFormulas> formulas_of(const Section& at, const std::string& key,
                                                 const std::vector<std::string>& texts,
                                                 std::span<const std::string> states) {
  if (texts.empty()) return nullptr;
  try {
    return std::make_shared<const StateFormulas>(texts, std::vector<std::string>(states.begin(), states.end()));
  } catch (const std::invalid_argument& error) {
    at.fail(key, error.what());
  }
}
std::shared_ptr<const StateFormulas> read_formulas(const Section& at, const KeyOf<Texts>& key,
                                                   std::span<const std::string> states) {
  return formulas_of(at, key.name, read_key(at, key), states);
}

std::vector<PhaseScene> read_phases(const Section& scene, std::span<const std::string> states,
                                    std::span<const std::string> controls, const ControlBounds& bounds,
                                    bool has_weights) {
  std::vector<PhaseScene> out;
  const std::vector<Section> tables = scene.tables("phase");
  for (const Section& table : tables) {
    PhaseScene phase;
    phase.table = table;
    phase.name = read_key_or(table, phase_keys::name, fmt::format("phase {}", out.size() + 1));
    if (std::any_of(out.begin(), out.end(), [&](const PhaseScene& other) { return other.name == phase.name; }))
      table.fail("name", fmt::format("\"{}\" is the name of another phase", phase.name));
    phase.duration = read_key(table, phase_keys::duration);
    phase.duration_is_free = read_key(table, phase_keys::free);
    if (table.has("range")) {
      if (!phase.duration_is_free) table.fail("range", "its duration is given; leave out range, or let it be free");
      const auto [shortest, longest] = read_range(table, "range", nonnegative, {phase.shortest, phase.longest});
      if (!(shortest < phase.duration && phase.duration < longest))
        table.fail("range", fmt::format("the first guess of the duration, {}, is not between {} and {}", phase.duration,
                                        shortest, longest));
      phase.shortest = shortest;
      phase.longest = longest;
    }
    phase.stages = read_key(table, phase_keys::stages);
    phase.constraints_hold = read_key(table, phase_keys::constraints);
    phase.bounds = read_bounds(table.section_or_empty("bounds"), controls, bounds);
    phase.weights = read_weights(table, controls, phase.duration_is_free);
    if (has_weights && !phase.weights && table.section_or_empty("parameters").has("cost"))
      table.fail("parameters",
                 "the scene's [weights] say what the motion costs: give the phase its own, or leave out cost");
    const Section through = table.section_or_empty("through");
    for (const std::string& state : states)
      phase.through.push_back(through.has(state) ? std::optional(read_key_or(through, phase_keys::through(state), 0))
                                                 : std::nullopt);
    phase.on = read_formulas(table, on_key("on"), states);
    through.finish();
    const bool is_last = out.size() + 1 == tables.size();
    for (const char* key : {"through", "on"})
      if (is_last && table.has(key)) table.fail(key, "the last phase ends where [boundary] says; leave it out");
    out.push_back(std::move(phase));
  }
  return out;
}

}  // namespace

void require_loop_scene(const Section& scene, const ControlScene& read) {
  if (!read.phases.empty()) scene.fail("phase", "a loop looks ahead in one phase; give [horizon]");
  for (const std::vector<bool>* free : {&read.free_start, &read.free_end})
    if (is_any(*free))
      scene.fail("boundary",
                 "a loop is between states that are given; leave out boundary.free_start and boundary.free_end");
  if (read.duration_is_free)
    scene.fail("horizon", "a loop looks ahead for a time that is given; leave out horizon.free");
  if (read.method != ControlMethod::interior_point)
    scene.fail("solver",
               "a loop is solved by the interior point method from sample to sample; leave out solver.method");
}

ControlScene read_control_scene(const Section& scene, std::span<const std::string> states,
                                std::span<const std::string> controls) {
  ControlScene out;
  const Section ends = scene.section("boundary", "start and end");
  out.start = read_key(ends, end_key("start", states));
  out.end = read_key(ends, end_key("end", states));
  out.free_start = read_names(ends, free_end_key("start"), states);
  out.free_end = read_names(ends, free_end_key("end"), states);
  out.start_on = read_formulas(ends, on_key("start_on"), states);
  out.end_on = read_formulas(ends, on_key("end_on"), states);
  const auto require_free = [&](const char* key, const StateFormulas* on, const std::vector<bool>& free) {
    const auto count = std::count(free.begin(), free.end(), true);
    if (on != nullptr && on->size() > count)
      ends.fail(
          fmt::format("{}_on", key),
          fmt::format("more formulas ({}) than numbers that are free ({}); name in free_{} what may differ from the {}",
                      on->size(), count, key, key));
  };
  require_free("start", out.start_on.get(), out.free_start);
  require_free("end", out.end_on.get(), out.free_end);
  if (ends.has(end_cost_key.name)) {
    if (!is_any(out.free_end))
      ends.fail(end_cost_key.name,
                "where the end is given this is the same for all motions; name in free_end what may differ from it");
    out.end_cost = formulas_of(ends, end_cost_key.name, {read_key_or(ends, end_cost_key, "")}, states);
    std::vector<double> numbers(1 + states.size() + states.size() * states.size());
    out.end_cost->values(out.end.data(), numbers.data());
    out.end_cost->derivatives(out.end.data(), numbers.data() + 1);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double each) { return std::isfinite(each); }))
      ends.fail(end_cost_key.name,
                "it, or a derivative of it, is no finite number at boundary.end, where the search begins; give another "
                "formula or end");
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  out.bounds = read_bounds(scene.section_or_empty("bounds"), controls, ControlBounds(controls.size(), {-none, none}));
  out.weights = read_weights(scene, controls, /*must_cost=*/!out.end_cost);
  out.phases = read_phases(scene, states, controls, out.bounds, out.weights.has_value());
  if (out.phases.empty()) {
    const Section horizon = scene.section("horizon", "duration and stages");
    out.duration = read_key(horizon, duration_key);
    out.duration_is_free = read_key(horizon, free_key);
    out.stages = read_key(horizon, stages_key);
  } else if (scene.has("horizon")) {
    scene.fail("horizon", "each [[phase]] has a duration and stages of its own; leave out [horizon]");
  }
  const bool is_free = out.duration_is_free || std::any_of(out.phases.begin(), out.phases.end(),
                                                           [](const auto& phase) { return phase.duration_is_free; });
  if (out.weights && !is_free && !out.end_cost &&
      std::all_of(out.weights->of_controls.begin(), out.weights->of_controls.end(), [](double w) { return w == 0; }))
    scene.fail("weights",
               "all motions cost the same where their time is given: give a control a weight, or let it be free");
  const Section solver = scene.section_or_empty("solver");
  out.method = read_method(solver);
  read_search(solver, out.search);
  if (scene.has("loop")) {
    require_loop_scene(scene, out);
    const Section loop = scene.section("loop", "samples");
    out.loop = LoopScene{.samples = read_key(loop, samples_key),
                         .disturbance = read_key(loop, disturbance_key),
                         .seed = out.search.seed,
                         .iterations = int(read_key(loop, loop_iterations_key)),
                         .tolerance = read_key(loop, loop_tolerance_key),
                         .usable = read_key(loop, usable_key)};
  }
  return out;
}

std::vector<Key> control_scene_keys(const ControlProblem& problem) {
  const std::vector<std::string> states = problem.states();
  std::vector<Key> bounds;
  for (const std::string& control : problem.controls()) bounds.push_back(bound_key(control));
  std::vector<Key> weights{weight_of_time_key};
  for (const std::string& control : problem.controls()) weights.push_back(weight_of_control_key(control));
  std::vector<Key> through;
  for (const std::string& state : states) through.push_back(phase_keys::through(state));
  const Table phase{{phase_keys::name, phase_keys::duration, phase_keys::free, phase_keys::range, phase_keys::stages,
                     phase_keys::constraints,
                     optional_table("through", {through}, "numbers of the state where it ends"), on_key("on"),
                     optional_table("bounds", {bounds}, "of the controls, in place of the scene's"),
                     optional_table("weights", {weights}, "of the cost, in place of the scene's"),
                     optional_table("parameters", {problem.parameters()}, "of the system, in place of the scene's")}};
  return {KeyOf<Table>{"boundary",
                       {{end_key("start", states), end_key("end", states), free_end_key("start"), free_end_key("end"),
                         on_key("start_on"), on_key("end_on"), end_cost_key}},
                       "",
                       "both ends"},
          KeyOf<Table>{"horizon",
                       {{duration_key, free_key, stages_key}},
                       "",
                       "how long, in how many arrows",
                       {},
                       "that of the phases"},
          KeyOf<Tables>{"phase", {phase}, "", "one after another, in place of the horizon", {}, "one"},
          optional_table("bounds", {bounds}, "of the controls"),
          optional_table("weights", {weights}, "of the cost, in place of the problem's own"),
          optional_table("solver", {search_keys()}, "of the search"),
          optional_table("loop", {{samples_key, disturbance_key, loop_iterations_key, loop_tolerance_key, usable_key}},
                         "the problem solved anew at every sample, of the length of a stage")};
}

}  // namespace lagroid::app
