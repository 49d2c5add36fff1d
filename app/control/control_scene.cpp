#include "control_scene.hpp"

#include <lagroid/solvers/control/ipopt/has_ipopt.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/missing_library.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <limits>

namespace lagroid::app {

namespace {

/// [solver] method of an optimal control problem; the first is the default.
constexpr std::array<Word<ControlMethod>, 2> control_words{
    {{"interior_point", ControlMethod::interior_point}, {"ipopt", ControlMethod::ipopt}}};

const NumberRule a_tolerance{"from 1e-13 to 1e-2", [](double x) { return x >= 1e-13 && x <= 1e-2; }};
const KeyOf<Number> duration_key{"duration", {positive}, "s", "T; where it is free, the first guess of it"};
const KeyOf<Flag> free_key{"free", {}, "", "true: the duration is an unknown", false};
const KeyOf<Whole> stages_key{"stages", {2, 1'000'000}, "", "N, arrows between the ends", 100L};
const KeyOf<Whole> starts_key{
    "starts", {1, 100'000}, "", "trajectories to start from: straight, drifting, then wound and bent", 10L};
const KeyOf<Whole> seed_key{"seed", {0, 4294967295}, "", "of the starts", 1L};
const KeyOf<Number> tolerance_key{
    "tolerance", {a_tolerance}, "", "on every part of the KKT residual", ControlOptions().tolerance};
const KeyOf<Whole> iterations_key{
    "iterations", {1, 1'000'000}, "", "of each start, at most", long(ControlOptions().max_iterations)};

KeyOf<OneOf> method_key() {
  const auto words = words_of(control_words);
  return {
      "method", {words}, "", "on the manifold of trajectories; by IPOPT in a chart of it, as a check", words.front()};
}

const KeyOf<Number> patience_key{"patience",
                                 {nonnegative},
                                 "",
                                 "a start is given up after so many times the iterations of the slowest that has "
                                 "converged, at least 100; 0: none is",
                                 ControlSearchOptions().patience};

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

KeyOf<NumberArray> bound_key(const std::string& control) {
  return {control, {2}, "", "least and largest value", {}, "none"};
}

}  // namespace

ControlScene read_control_scene(const Section& scene, std::span<const std::string> states,
                                std::span<const std::string> controls) {
  ControlScene out;
  const Section ends = scene.section("boundary", "start and end");
  out.start = read_key(ends, end_key("start", states));
  out.end = read_key(ends, end_key("end", states));
  const Section horizon = scene.section("horizon", "duration and stages");
  out.duration = read_key(horizon, duration_key);
  out.duration_is_free = read_key(horizon, free_key);
  out.stages = read_key(horizon, stages_key);
  const Section bounds = scene.section_or_empty("bounds");
  constexpr double none = std::numeric_limits<double>::infinity();
  for (const std::string& control : controls) {
    if (!bounds.has(control)) {
      out.bounds.emplace_back(-none, none);
      continue;
    }
    const auto range = read_key_or(bounds, bound_key(control), {});
    if (!(range[0] < range[1]))
      bounds.fail(control, fmt::format("{} is not below {}; give the lower bound first", range[0], range[1]));
    out.bounds.emplace_back(range[0], range[1]);
  }
  const Section solver = scene.section_or_empty("solver");
  out.method = choice_of(control_words, read_key(solver, method_key()));
  if (out.method == ControlMethod::ipopt && !has_ipopt())
    solver.fail("method", MissingLibrary("\"ipopt\"", "IPOPT", "coinor-libipopt-dev").what());
  out.search.starts = int(read_key(solver, starts_key));
  out.search.seed = std::uint64_t(read_key(solver, seed_key));
  out.search.solver.tolerance = read_key(solver, tolerance_key);
  out.search.patience = read_key(solver, patience_key);
  out.search.solver.max_iterations = int(read_key(solver, iterations_key));
  if (scene.has("loop")) {
    if (out.duration_is_free) scene.fail("loop", "looks ahead for a time that is given; leave out horizon.free");
    if (out.method != ControlMethod::interior_point)
      scene.fail("loop", "is solved by the interior point method from sample to sample; leave out solver.method");
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
  return {KeyOf<Table>{"boundary", {{end_key("start", states), end_key("end", states)}}, "", "both ends"},
          KeyOf<Table>{"horizon", {{duration_key, free_key, stages_key}}, "", "how long, in how many arrows"},
          optional_table("bounds", {bounds}, "of the controls"),
          optional_table("solver", {{method_key(), starts_key, seed_key, tolerance_key, iterations_key, patience_key}},
                         "of the search"),
          optional_table("loop", {{samples_key, disturbance_key, loop_iterations_key, loop_tolerance_key, usable_key}},
                         "the problem solved anew at every sample, of the length of a stage")};
}

}  // namespace lagroid::app
