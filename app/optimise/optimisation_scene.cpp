#include "optimisation_scene.hpp"

#include "matrices.hpp"
#include "methods.hpp"
#include "problems.hpp"

#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>

#include <fmt/format.h>

#include <stdexcept>

namespace lagroid::app {

namespace {

using optimisation::Instance, optimisation::Point, optimisation::Stopping;

/// Start: a file, or else a random point; of O(n), in the component that is asked for.
Point read_start(const Section& scene, const Instance& instance, const std::filesystem::path& folder) {
  const Section start = scene.section_or_empty("start");
  const auto seed = unsigned(start.integer_or("seed", 1, 0, 4294967295));
  Point x;
  if (start.has("file")) {
    Eigen::MatrixXd matrix;
    try {
      matrix = dense(read_matrix(start.text("file", "the name of a file"), folder));
    } catch (const DataError& error) {
      start.fail("file", error.what());
    }
    if (matrix.rows() != instance.rows || matrix.cols() != instance.columns)
      start.fail("file", fmt::format("{} x {} numbers, points of the {} have {} x {}", matrix.rows(), matrix.cols(),
                                     instance.manifold->name(), instance.rows, instance.columns));
    x = matrix.reshaped();
    if (start.flag_or("nearest", false) && !instance.manifold->nearest(x))
      start.fail("file", fmt::format("no point of the {} is nearest to it", instance.manifold->name()));
    constexpr double on_it = 1e-8;
    if (const double off = instance.manifold->residual(x); off > on_it)
      start.fail("file", fmt::format("off the {} by {:.1e}; start.nearest = true takes the nearest point of it",
                                     instance.manifold->name(), off));
  } else {
    x = optimisation::random_start(*instance.manifold, seed);
  }
  if (start.has("component")) {
    if (instance.rows != instance.columns) start.fail("component", "only O(n) has two components");
    const long component = start.integer("component", -1, 1);
    Eigen::Map<Eigen::MatrixXd> matrix(x.data(), instance.rows, instance.columns);
    if (component == 0) start.fail("component", "1 or -1, the sign of the determinant");
    if (optimisation::component(matrix) != component) matrix.col(0) *= -1;
  }
  return x;
}

Stopping read_stopping(const Section& scene) {
  const Section stop = scene.section_or_empty("stop");
  Stopping out;
  out.gradient = stop.number_or("gradient", 0, nonnegative);
  const bool other = stop.has("gradient") || stop.has("gap") || stop.has("value");
  constexpr NumberRule share{"from 0 to below 1", [](double x) { return x >= 0 && x < 1; }};
  out.relative_gradient = stop.number_or("relative_gradient", other ? 0 : 1e-8, share);
  out.iterations = stop.integer_or("iterations", out.iterations, 1, 1'000'000'000);
  if (stop.has("seconds")) out.seconds = stop.number("seconds", positive);
  out.patience = stop.integer_or("patience", out.patience, 0, 1'000'000'000);
  if (stop.has("value")) out.value = stop.number("value");
  return out;
}

}  // namespace

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
  const double gap = stop.number_or("gap", 0, positive);
  const bool reference = scene.flag_or("reference", wants_gap);
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
