#include "simulation.hpp"

#include "scene_keys.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace lagroid::app {

TimeGrid read_time(const Section& scene) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  TimeGrid grid;
  const bool has_duration = time.has(time_keys::duration.name);
  const bool has_step = time.has(time_keys::step.name);
  constexpr double first_tried = 0.01;
  if (has_step && time.has("accuracy")) time.fail("accuracy", "finds the first step: leave out step or accuracy");
  if (has_duration && has_step) time.fail("duration", "give step or duration, not both (steps goes with either)");
  grid.steps = read_key(time, time_keys::steps);
  grid.step = has_duration                        ? read_key(time, time_keys::duration) / double(grid.steps)
              : !has_step && time.has("accuracy") ? first_tried
                                                  : read_key(time, time_keys::step);
  const char* const key = has_duration ? "duration" : "step";
  if (grid.step < std::numeric_limits<double>::min())
    time.fail(key, fmt::format("makes steps of {:g} s, too short to keep their digits", grid.step));
  if (!std::isfinite(grid.step * double(grid.steps)))
    time.fail(key, fmt::format("{} steps of {:g} s have no finite end", grid.steps, grid.step));
  return grid;
}

double read_start(const Section& scene) {
  const Section time = scene.section_or_empty("time");
  const double start = read_key(time, time_keys::start);
  if (start + 0.5 * read_time(scene).step == start)
    time.fail("start", "is so late that a step is lost in its rounding; begin earlier");
  return start;
}

void refuse_accuracy(const Section& scene) {
  const Section time = scene.section_or_empty("time");
  if (time.has("accuracy"))
    time.fail("accuracy", "finds the first of variational steps from [initial]; give step or duration here");
}

Composition read_composition(const Section& time, std::span<const Composition> offered) {
  const long order = read_key(time, time_keys::order());
  const Composition* const usual = usual_composition(order);
  if (usual == nullptr) time.fail("order", fmt::format("must be {}, got {}", usual_orders(), order));
  const std::string name = read_key(time, time_keys::composition(offered, usual->name));
  const Composition* const named = composition_named(offered, name);
  if (named == nullptr) return *usual;
  if (time.has("order") && named->order != order)
    time.fail("composition",
              fmt::format("\"{}\" is of order {}, not {}; leave out order or composition", name, named->order, order));
  return *named;
}

namespace {

std::string read_mode_word(const Section& time) { return read_key(time, time_keys::mode()); }

}  // namespace

std::optional<double> read_tolerance(const Section& time, bool by_tolerance) {
  if (by_tolerance) {
    if (!time.has("tolerance"))
      time.fail("method", "takes its order and its steps from a tolerance: add tolerance = 1e-9");
    return read_key(time, time_keys::tolerance);
  }
  if (time.has("tolerance"))
    time.fail("tolerance", fmt::format("goes with method = \"{}\"", extrapolation_method.name));
  return {};
}

namespace {

/// What a system can do, with the words for what it cannot.
struct Able {
  const Capabilities& capabilities;
  std::string_view system;
  std::string_view remedy;

  /// Refuses a key that asks for what the system lacks.
  void require(const Section& time, std::string_view key, std::span<const Requirement> requirements) const {
    if (const Requirement* lacking = unmet(requirements, capabilities))
      time.fail(key, fmt::format("{} has no {}; {}", system, lacking->what, remedy));
  }
};

/// The options of the method itself.
void read_options(const Section& time, const IntegrationMethod& method, const Able& able, IntegratorOptions& options) {
  if (method.composed()) {
    const bool flows = method.other_orders == OtherOrders::composed_flows;
    options.composition =
        read_composition(time, flows ? std::span<const Composition>(able.capabilities.splittings) : compositions::all);
    if (!flows && options.composition.stages() > 1)
      able.require(time, time.has("order") ? "order" : "composition", requirements::of_composed_steps);
  } else {
    if (time.has("composition"))
      time.fail("composition",
                fmt::format("goes with steps that are composed, which \"{}\" ones are not; leave it out", method.name));
    if (read_key(time, time_keys::order(method.order)) != method.order)
      time.fail("order", method.by_tolerance()
                             ? fmt::format("of \"{}\" follows its tolerance; leave it out", method.name)
                             : fmt::format("of \"{}\" is {}", method.name, method.order));
  }
  if (const auto tolerance = read_tolerance(time, method.by_tolerance())) options.tolerance = *tolerance;
  if (options.mode == TimeMode::adaptive) {
    options.without_root = choice_of(without_root_words, read_key(time, time_keys::without_root()));
    if (options.without_root == WithoutRoot::controlled)
      able.require(time, "without_root", requirements::of_controlled);
  } else if (time.has("without_root")) {
    time.fail("without_root",
              fmt::format("goes with mode = \"{}\"", integration_method({.mode = TimeMode::adaptive}).name));
  }
}

void read_solver(const Section& solver, IntegratorOptions& options) {
  options.method = choice_of(solver_words, read_key(solver, solver_keys::method()));
  options.step.max_iterations = int(read_key_or(solver, solver_keys::max_iterations, options.step.max_iterations));
  options.step.tolerance = read_key(solver, solver_keys::tolerance);
}

}  // namespace

std::string read_method_word(const Section& time, std::span<const DeclaredMethod> own) {
  std::vector<std::string> words = method_words();
  for (const DeclaredMethod& each : own) words.emplace_back(each.name);
  const std::string word = read_key(time, time_keys::method(std::move(words)));
  if (time.has("method") && read_mode_word(time) != mode_of_equal_steps)
    time.fail("method", fmt::format("goes with mode = \"{}\"", mode_of_equal_steps));
  return word;
}

const DeclaredMethod& read_declared_method(const Section& time, std::span<const DeclaredMethod> own) {
  const std::string word = read_method_word(time, own);
  for (const DeclaredMethod& each : own)
    if (each.name == word) return each;
  return integration_method(read_mode_word(time), word);
}

IntegratorChoice read_integrator(const Section& scene, const Capabilities& capabilities, std::string_view system,
                                 std::string_view remedy) {
  const Able able{capabilities, system, remedy};
  const Section time = scene.section("time", "step and steps, or duration and steps");
  const IntegrationMethod& method = integration_method(read_mode_word(time), read_method_word(time, {}));
  able.require(time, method.equal_steps() ? "method" : "mode", method.needs);
  IntegratorChoice choice;
  IntegratorOptions& options = choice.options;
  options = options_of(method);
  read_options(time, method, able, options);
  if (!method.equal_steps()) refuse_duration(time);
  if (time.has("accuracy")) {
    choice.accuracy = read_key(time, time_keys::accuracy);
    if (time.has("duration")) time.fail("accuracy", "chooses the step: leave out duration");
    if (options.fixed != StepKind::variational || options.composition.stages() > 1)
      time.fail("accuracy", "chooses steps of order 2; give step, or leave out order, method and composition");
  }
  read_solver(scene.section_or_empty("solver"), options);
  return choice;
}

std::vector<Method> composed_methods(std::string_view step, std::span<const Composition> composed_by) {
  std::vector<Method> all;
  for (const auto& composition : composed_by)
    all.push_back({composed_name(step, composition),
                   composition.order,
                   composition.stages(),
                   true,
                   {fmt::format("time.method={}", step), fmt::format("time.composition={}", composition.name)}});
  return all;
}

namespace {

/// What [time] of a scene says for them.
std::vector<std::string> settings_of(const IntegratorOptions& options) {
  const IntegrationMethod& method = integration_method(options);
  std::vector<std::string> settings{
      fmt::format("time.mode={}", method.equal_steps() ? mode_of_equal_steps : method.name)};
  if (method.equal_steps()) settings.push_back(fmt::format("time.method={}", method.name));
  if (method.composed()) settings.push_back(fmt::format("time.composition={}", options.composition.name));
  if (method.by_tolerance()) settings.push_back(fmt::format("time.tolerance={:g}", options.tolerance));
  return settings;
}

}  // namespace

std::vector<Method> integration_methods(const Capabilities& able) {
  std::vector<Method> all;
  for (const NamedMethod& m : named_methods(able))
    all.push_back({m.name, m.order, m.stages, m.equal_steps, settings_of(m.options), m.to_compare});
  return all;
}

void refuse_to_reduce(const Section& scene, std::string_view why) {
  if (scene.has(reduce_word)) scene.fail(reduce_word, std::string(why));
}

long read_every(const Section& scene) { return read_key(scene.section_or_empty("output"), output_keys::every); }

void refuse_duration(const Section& time) {
  if (time.has("duration"))
    time.fail("duration", "is not kept by steps that vary: give step, the first one, and steps");
}

namespace {

/// The scene to be kept: with the step itself in place of a duration, so that more steps can be asked for later.
std::string kept_scene(const Section& scene) {
  if (!scene.section_or_empty("time").has("duration")) return scene.whole();
  return scene.with("time.step", {read_time(scene).step}).without("time.duration").whole();
}

}  // namespace

std::vector<Event> read_events(const Section& scene) {
  using namespace event_keys;
  std::vector<Event> events;
  for (const Section& table : scene.tables(event_key().name)) {
    Event event{read_key(table, name), read_key(table, when)};
    const std::string place = read_key(table, at);
    const std::string way = read_key(table, direction);
    event.at = place == "zero" ? Event::At::zero : place == "minimum" ? Event::At::minimum : Event::At::maximum;
    event.direction = way == "both"     ? Event::Direction::both
                      : way == "rising" ? Event::Direction::rising
                                        : Event::Direction::falling;
    event.then = read_key(table, then) == "stop" ? Event::Then::stop : Event::Then::record;
    event.count = read_key(table, count);
    event.tolerance = read_key(table, tolerance);
    event.kick = read_key_or(table, kick, {});
    for (const std::string& text : read_key_or(table, event_keys::set, {})) {
      const auto setting = event_setting(text);
      if (!setting)
        table.fail(event_keys::set.name, fmt::format("\"{}\" is not of the form \"name = expression\"", text));
      event.set.push_back(*setting);
    }
    event.body = read_key_or(table, body, "");
    event.switch_on = read_key_or(table, switch_on, {});
    event.switch_off = read_key_or(table, switch_off, {});
    event.plot = read_key_or(table, plot, {});
    if (event.at != Event::At::zero && table.has(direction.name))
      table.fail(direction.name, "is that of events at zero; leave it out");
    if (event.then == Event::Then::record && table.has(count.name))
      table.fail(count.name, "goes with then = \"stop\"; every time is counted");
    events.push_back(std::move(event));
  }
  return events;
}

RunExtent read_extent(const Section& scene, const RunContext& context) {
  RunExtent extent;
  extent.steps = read_time(scene).steps;
  extent.every = read_every(scene);
  extent.checkpoint = read_key_or(scene.section_or_empty("output"), output_keys::checkpoint, 0);
  extent.events = read_events(scene);
  extent.events.insert(extent.events.end(), context.events.begin(), context.events.end());
  if (!context.folder.empty() && !context.resume) extent.scene = kept_scene(scene);
  return extent;
}

}  // namespace lagroid::app
