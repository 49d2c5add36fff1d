#include "optimisation_scene.hpp"

#include "../reading/kinds.hpp"
#include "matrices.hpp"
#include "methods.hpp"
#include "problems.hpp"

#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid::app {

namespace {

using optimisation::Instance, optimisation::Point, optimisation::Stopping;

const KeyOf<Whole> start_seed_key{"seed", {0, 4294967295}, "", "of a random start", 1};
const KeyOf<Text> file_key{
    "file", {}, "", "the name of a file; without it the start is random, or the first point of a mean"};
const KeyOf<Flag> nearest{"nearest", {}, "", "true: the point of the manifold that is nearest to the file's", false};
const KeyOf<Whole> component_key{"component", {-1, 1},      "", "of O(n): 1 or -1, the sign of the determinant",
                                 {},          "as it comes"};

const KeyOf<Number> gradient{"gradient", {nonnegative}, "", "stop at this norm of it", 0.0};
const KeyOf<Number> relative_gradient{"relative_gradient",
                                      {{"from 0 to below 1", [](double x) { return x >= 0 && x < 1; }}},
                                      "",
                                      "stop at this norm of it over that at the start",
                                      {},
                                      "1e-8 where nothing else stops, else 0"};
const KeyOf<Number> gap_key{
    "gap", {positive}, "", "stop so far above the least value, where it is known without optimisation", {}, "none"};
const KeyOf<Number> value{"value", {}, "", "stop at this value", {}, "none"};
const KeyOf<Whole> iterations{"iterations", {1, 1'000'000'000}, "", "at most", long(Stopping().iterations)};
const KeyOf<Number> seconds{"seconds", {positive}, "s", "at most", {}, "any number"};
const KeyOf<Whole> patience{"patience",
                            {0, 1'000'000'000},
                            "",
                            "iterations without progress, at most; 0: any number",
                            long(Stopping().patience)};
const KeyOf<Flag> reference_key{
    "reference", {},
    "",          "compare with the least value that linear algebra finds, of means of two points their distance",
    {},          "true with `gap` of [stop]"};

/// Start: a file, or else the problem's, or else a random point; of O(n), in the component that is asked for.
Point read_start(const Section& scene, const Instance& instance, const std::filesystem::path& folder) {
  const Section start = scene.section_or_empty("start");
  const auto seed = unsigned(read_key(start, start_seed_key));
  if (instance.start && start.has(start_seed_key.name))
    start.fail(start_seed_key.name, "a mean starts from its first point, or from a file");
  Point x;
  if (start.has("file")) {
    Eigen::MatrixXd matrix;
    try {
      matrix = dense(read_matrix(read_key(start, file_key), folder));
    } catch (const DataError& error) {
      start.fail("file", error.what());
    }
    if (matrix.rows() != instance.rows || matrix.cols() != instance.columns)
      start.fail("file", fmt::format("{} x {} numbers, points of the {} have {} x {}", matrix.rows(), matrix.cols(),
                                     instance.manifold->name(), instance.rows, instance.columns));
    x = matrix.reshaped();
    if (read_key(start, nearest) && !instance.manifold->nearest(x))
      start.fail("file", fmt::format("no point of the {} is nearest to it", instance.manifold->name()));
    constexpr double on_it = 1e-8;
    if (const double off = instance.manifold->residual(x); off > on_it)
      start.fail("file", fmt::format("off the {} by {:.1e}; start.nearest = true takes the nearest point of it",
                                     instance.manifold->name(), off));
  } else {
    x = instance.start ? *instance.start : optimisation::random_start(*instance.manifold, seed);
  }
  if (start.has("component")) {
    if (instance.rows != instance.columns || instance.start) start.fail("component", "only O(n) has two components");
    const long component = read_key(start, component_key);
    Eigen::Map<Eigen::MatrixXd> matrix(x.data(), instance.rows, instance.columns);
    if (component == 0) start.fail("component", "1 or -1, the sign of the determinant");
    if (optimisation::component(matrix) != component) matrix.col(0) *= -1;
  }
  return x;
}

Stopping read_stopping(const Section& scene) {
  const Section stop = scene.section_or_empty("stop");
  Stopping out;
  out.gradient = read_key(stop, gradient);
  const bool other = stop.has("gradient") || stop.has("gap") || stop.has("value");
  out.relative_gradient = read_key_or(stop, relative_gradient, other ? 0 : 1e-8);
  out.iterations = read_key(stop, iterations);
  out.seconds = read_key_or(stop, seconds, out.seconds);
  out.patience = read_key(stop, patience);
  out.value = read_key_or(stop, value, out.value);
  return out;
}

}  // namespace

Table optimisation_table() {
  Table table{
      {optional_table("method", optimisers_table(), "by which it is minimised"),
       optional_table("start", {{component_key, start_seed_key}, {{{file_key, nearest}}, {}}}, "where it begins"),
       optional_table("stop", {{relative_gradient, gradient, gap_key, value, iterations, seconds, patience}},
                      "when it ends"),
       reference_key}};
  for (const auto& entry : problems()) {
    Table kind{
        {KeyOf<OneOf>{std::string(keys::optimisation), {{std::string(entry.name)}}, "", std::string(entry.summary)},
         KeyOf<Table>{"data", {entry.data}, "", "the matrices of the problem"}},
        {},
        std::string(entry.summary)};
    if (!entry.parameters.empty())
      kind.keys.push_back(KeyOf<Table>{"parameters", {entry.parameters}, "", "of the problem"});
    table.kinds.push_back(std::move(kind));
  }
  return table;
}

OptimisationScene read_optimisation(const Section& scene, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  OptimisationScene out;
  out.instance = read_problem(scene, folder);
  out.problem = out.instance.objective->name();
  out.start = read_start(scene, out.instance, folder);
  const Section method = scene.section_or_empty("method");
  out.method = read_optimiser(method);
  out.penalty = read_penalty(method);
  out.stopping = read_stopping(scene);
  const Section stop = scene.section_or_empty("stop");
  const bool wants_gap = stop.has("gap");
  const double gap = read_key_or(stop, gap_key, 0);
  const bool reference = read_key_or(scene, reference_key, wants_gap);
  scene.finish();
  if (out.penalty && (reference || wants_gap))
    scene.fail(wants_gap ? "stop" : "reference", "a penalty goes below the minimum; stop by the gradient");
  if (reference || wants_gap) {
    if (!out.instance.least)
      scene.fail(wants_gap ? "stop" : "reference",
                 "nobody knows the least value of this problem without optimisation; stop by the gradient");
    try {
      out.least = out.instance.least(out.start);
    } catch (const std::runtime_error& error) {
      scene.fail("reference", error.what());
    }
    if (wants_gap) out.stopping.value = *out.least + gap;
  }
  return out;
}

}  // namespace lagroid::app
