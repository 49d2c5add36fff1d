#include "optimise.hpp"

#include "../command/written.hpp"
#include "../families/family.hpp"
#include "methods.hpp"
#include "optimisation_files.hpp"
#include "problems.hpp"

#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/progress.hpp>
#include <lagroid/solvers/optimisation/penalised.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <new>
#include <stdexcept>

namespace lagroid::app {

namespace {

std::string listing() {
  std::string out;
  const auto list = [&](const std::vector<Key>& keys, const char* table = "") {
    for (const Key& key : keys) out += fmt::format("    {:<18} {}\n", table + key.name, listed(key));
  };
  out += "problems\n";
  for (const auto& entry : problems()) {
    out += fmt::format("  {:<22} {}\n", entry.name, entry.summary);
    list(entry.data, "data.");
    list(entry.parameters, "parameters.");
  }
  out += "methods\n";
  for (const auto& entry : optimisers()) {
    out += fmt::format("  {:<22} {}\n", entry.name, entry.summary);
    list(entry.keys);
  }
  return out;
}

}  // namespace

void add_optimise_options(CLI::App& command, OptimiseOptions& options) {
  command.add_option("scene", options.scene, "the scene, a TOML file");
  command.add_option("--set", options.overrides, "override a key: --set method.name=adaptive (repeatable)")
      ->allow_extra_args(false);
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
  command.add_option("--out", options.out, "write history, point, plot and summary files into this folder");
  command.add_flag("--list", options.list, "list problems and methods with their keys");
}

namespace {

int run(const OptimiseOptions& options) {
  if (options.list) {
    print(listing());
    return 0;
  }
  if (options.scene.empty())
    return refuse(options.json, exit_bad_input, "invalid_command_line", "name a scene; see lagroid optimize --help");
  const Section file = read_scene(options.scene, options.overrides);
  require_command(file, "optimize");
  OptimisationScene scene = read_optimisation(file, options.scene);
  std::optional<OutputFolder> folder;
  if (options.out) folder.emplace(folder_for_optimisation(*options.out, file));
  const InterruptGuard guard;
  optimisation::Result result;
  try {
    Progress progress(scene.problem, scene.stopping.iterations, !options.json);
    const auto watch = [&](const optimisation::Iterate& now, const optimisation::Point&) {
      progress.update(now.iteration);
      return !guard.interrupted();
    };
    const optimisation::Recording recording{.history = options.out.has_value(), .callback = watch};
    const optimisation::Manifold& manifold = *scene.instance.manifold;
    const optimisation::Objective& objective = *scene.instance.objective;
    result = scene.penalty
                 ? optimisation::minimise_penalised(manifold, objective, *scene.penalty, scene.start, *scene.method,
                                                    scene.stopping, recording)
                 : optimisation::minimise(manifold, objective, scene.start, *scene.method, scene.stopping, recording);
  } catch (const std::invalid_argument& error) {
    file.section_or_empty("method").fail("", error.what());
  }
  std::string text = optimisation_text(scene, result);
  auto json = optimisation_json(scene, result);
  if (options.out) {
    std::string note;
    const auto files = write_optimisation(scene, result, *options.out, note);
    tell_written(files, note, text, json);
  } else {
    text += "  (no files written; --out DIR writes history, point, plot and summary)\n";
  }
  print(options.json ? json_text(json) + "\n" : text);
  if (result.converged()) return code_after_writing(0, options.scene);
  complain(fmt::format("{}: {}", options.scene, result.message));
  return result.outcome == optimisation::MinimisationStatus::interrupted ? exit_interrupted : exit_failed;
}

}  // namespace

int optimise(const OptimiseOptions& options) {
  try {
    return run(options);
  } catch (const std::bad_alloc&) {
    return refuse(options.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; give a sparse matrix (.mtx), a smaller one, or fewer stop.iterations",
                              options.scene));
  }
}

}  // namespace lagroid::app
