#include "simulation.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace lagroid::app {

namespace {

constexpr long most_apart = 1'000'000'000;  // rows, checkpoints

}  // namespace

TimeGrid read_time(const Section& scene) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  constexpr long most = 2'000'000'000;
  TimeGrid grid;
  const bool has_duration = time.has("duration");
  const bool has_step = time.has("step");
  constexpr double first_tried = 0.01;
  if (has_step && time.has("accuracy")) time.fail("accuracy", "finds the first step: leave out step or accuracy");
  if (has_duration && has_step) time.fail("duration", "give step or duration, not both (steps goes with either)");
  grid.steps = time.integer("steps", 1, most);
  grid.step = has_duration                        ? time.number("duration", positive) / double(grid.steps)
              : !has_step && time.has("accuracy") ? first_tried
                                                  : time.number("step", positive);
  const char* const key = has_duration ? "duration" : "step";
  if (grid.step < std::numeric_limits<double>::min())
    time.fail(key, fmt::format("makes steps of {:g} s, too short to keep their digits", grid.step));
  if (!std::isfinite(grid.step * double(grid.steps)))
    time.fail(key, fmt::format("{} steps of {:g} s have no finite end", grid.steps, grid.step));
  return grid;
}

double read_start(const Section& scene) {
  const Section time = scene.section_or_empty("time");
  const double start = time.number_or("start", 0);
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
  const long order = time.integer_or("order", 2, 2, 8);
  if (order % 2 != 0) time.fail("order", fmt::format("must be 2, 4, 6 or 8, got {}", order));
  constexpr std::array defaults{compositions::single, compositions::suzuki, compositions::kahan_li_6,
                                compositions::kahan_li_8};
  const Composition& usual = defaults[std::size_t(order / 2 - 1)];
  std::vector<std::string> names;
  for (const auto& composition : offered) names.emplace_back(composition.name);
  const std::string name = time.choice_or("composition", std::string(usual.name), names);
  for (const auto& composition : offered) {
    if (composition.name != name) continue;
    if (time.has("order") && composition.order != order)
      time.fail("composition", fmt::format("\"{}\" is of order {}, not {}; leave out order or composition", name,
                                           composition.order, order));
    return composition;
  }
  return usual;
}

namespace {

void read_stepper(const Section& solver, MarchOptions& options) {
  if (solver.choice_or("method", "newton", {"newton", "ceres"}) == "ceres") options.method = StepMethod::ceres;
  if (solver.has("max_iterations")) options.step.max_iterations = int(solver.integer("max_iterations", 1, 100000));
  options.step.tolerance = solver.number_or("tolerance", 0, nonnegative);
}

}  // namespace

MarchChoice read_march(const Section& scene, const Abilities& able) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  MarchChoice choice;
  MarchOptions& options = choice.options;
  const auto need = [&](bool has, std::string_view key, std::string_view what) {
    if (!has) time.fail(key, fmt::format("this system has no {}; see docs/time.md for those that do", what));
  };
  const std::string_view timed = able.variational ? "Lagrangian for every step size" : "action principle";
  const std::string mode = time.choice_or("mode", "fixed", {"fixed", "adaptive", "controlled", "transformed"});
  if (mode == "fixed") {
    const std::string method = time.choice_or("method", "variational", {"variational", "splitting", "runge-kutta"});
    if (method == "runge-kutta") {
      options.fixed = StepKind::runge_kutta;
      need(able.rates, "method", "vector field written for it");
      if (time.integer_or("order", 4, 2, 8) != 4) time.fail("order", "of Runge-Kutta steps is 4");
      if (time.has("composition")) time.fail("composition", "is of symmetric steps; leave it out");
    } else if (method == "splitting") {
      options.fixed = StepKind::splitting;
      need(!able.splittings.empty(), "method", "explicit splitting");
      options.composition = read_composition(time, able.splittings);
    } else {
      options.composition = read_composition(time, compositions::all);
    }
    if (options.fixed == StepKind::variational && options.composition.stages() > 1)
      need(able.variational, time.has("order") ? "order" : "composition", "action principle, and no order above 2");
  } else if (mode == "adaptive") {
    need(able.timed, "mode", timed);
    options.mode = TimeMode::adaptive;
    const std::string instead = time.choice_or("without_root", "stop", {"stop", "constant", "controlled"});
    if (instead == "constant") options.without_root = WithoutRoot::constant;
    if (instead == "controlled") {
      need(able.time_scale, "without_root", "time scale to control steps by");
      options.without_root = WithoutRoot::controlled;
    }
  } else if (mode == "transformed") {
    need(able.attractive, "mode", "attraction whose energy is negative everywhere");
    options.mode = TimeMode::transformed;
    options.composition = read_composition(time, compositions::all);
  } else {
    need(able.time_scale, "mode", able.variational ? "time scale to control steps by" : timed);
    options.mode = TimeMode::controlled;
  }
  if (mode != "fixed") {
    if (time.has("method")) time.fail("method", "goes with mode = \"fixed\"");
    if (mode != "transformed") {
      if (time.has("composition")) time.fail("composition", "goes with mode = \"fixed\" or \"transformed\"");
      if (time.integer_or("order", 2, 2, 8) != 2)
        time.fail("order", "above 2 goes with mode = \"fixed\" or \"transformed\"");
    }
    refuse_duration(time);
  }
  if (mode != "adaptive" && time.has("without_root")) time.fail("without_root", "goes with mode = \"adaptive\"");
  if (time.has("accuracy")) {
    choice.accuracy = time.number("accuracy", positive);
    if (time.has("duration")) time.fail("accuracy", "chooses the step: leave out duration");
    if (options.fixed != StepKind::variational || options.composition.stages() > 1)
      time.fail("accuracy", "chooses steps of order 2; give step, or leave out order, method and composition");
  }
  read_stepper(scene.section_or_empty("solver"), options);
  return choice;
}

std::vector<Method> composed_methods(const std::string& step, std::span<const Composition> composed_by) {
  std::vector<Method> all;
  for (const auto& composition : composed_by)
    all.push_back({composed_name(step, composition),
                   composition.order,
                   composition.stages(),
                   true,
                   {"time.mode=fixed", "time.method=" + step, fmt::format("time.composition={}", composition.name)}});
  return all;
}

namespace {

/// What [time] of a scene says for them.
std::vector<std::string> settings_of(const MarchOptions& options) {
  const std::string composition = fmt::format("time.composition={}", options.composition.name);
  switch (options.mode) {
    case TimeMode::adaptive:
      return {"time.mode=adaptive"};
    case TimeMode::controlled:
      return {"time.mode=controlled"};
    case TimeMode::transformed:
      return {"time.mode=transformed", composition};
    default:
      break;
  }
  if (options.fixed == StepKind::runge_kutta) return {"time.method=runge-kutta"};
  return {"time.mode=fixed", options.fixed == StepKind::splitting ? "time.method=splitting" : "time.method=variational",
          composition};
}

}  // namespace

std::vector<Method> march_methods(const Abilities& able) {
  std::vector<Method> all;
  for (const NamedMethod& m : named_methods(able))
    all.push_back({m.name, m.order, m.stages, m.equal_steps, settings_of(m.options), m.to_compare});
  return all;
}

long read_every(const Section& scene) { return scene.section_or_empty("output").integer_or("every", 1, 1, most_apart); }

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

Pace read_pace(const Section& scene, const RunContext& context) {
  Pace pace;
  pace.steps = read_time(scene).steps;
  pace.every = read_every(scene);
  pace.checkpoint = scene.section_or_empty("output").integer_or("checkpoint", 0, 1, most_apart);
  if (!context.folder.empty() && !context.resume) pace.scene = kept_scene(scene);
  return pace;
}

}  // namespace lagroid::app
