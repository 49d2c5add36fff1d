/// The command line.

#include "output.hpp"
#include "registry.hpp"
#include "report.hpp"

#include <fmt/format.h>
#include <glog/logging.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace lagroid::app;

constexpr int exit_internal_error = 1;
constexpr int exit_bad_input = 2;
constexpr int exit_failed = 3;

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<std::string> out;
  bool json = false;
};

/// Prints on standard output, or throws OutputError.
void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output could not be written");
}

/// Ends a run that has no result: one line, and one JSON object where that was asked for.
int refuse(const RunOptions& options, int code, const std::string& status, const std::string& message) {
  fmt::print(stderr, "lagroid: {}\n", message);
  if (options.json) print(json_error(status, message) + "\n");
  return code;
}

int run(const RunOptions& options) {
  RunResult result;
  try {
    const Section scene = read_scene(options.scene, options.overrides);
    if (options.out) require_writable(*options.out);
    result = run_scene(scene, {.record = options.out.has_value(), .progress = !options.json});
  } catch (const SceneError& error) {
    return refuse(options, exit_bad_input, "invalid_scene", error.what());
  } catch (const OutputError& error) {
    return refuse(options, exit_bad_input, "invalid_scene", error.what());
  }
  std::string report;
  if (options.out) {
    try {
      for (const auto& file : write_outputs(result, *options.out)) report += fmt::format("  wrote {}\n", file.string());
    } catch (const OutputError& error) {
      result.output_error = error.what();
    }
  } else {
    report = "  (no files written; --out DIR writes trajectory, plot and summary)\n";
  }
  print(options.json ? json_report(result) + "\n" : text_report(result) + report);
  if (!result.converged()) fmt::print(stderr, "lagroid: {}: {}\n", options.scene, result.message);
  if (!result.output_error.empty()) fmt::print(stderr, "lagroid: {}\n", result.output_error);
  return result.converged() && result.output_error.empty() ? 0 : exit_failed;
}

int list() {
  std::string lines;
  for (const auto& entry : systems()) lines += fmt::format("{:<20} {}\n", entry.name, entry.summary);
  print(lines);
  return 0;
}

/// Reads the command line and does what it says.
int serve(int argc, char** argv) {
  CLI::App app{"lagroid: discrete mechanics on Lie groupoids"};
  app.set_version_flag("--version", LAGROID_VERSION);

  RunOptions options;
  CLI::App* run_command = app.add_subcommand("run", "run a scene (see docs/scenes.md)");
  run_command->add_option("scene", options.scene, "the scene, a TOML file")->required();
  run_command->add_option("--set", options.overrides, "override a key: --set time.steps=100 (repeatable)")
      ->allow_extra_args(false);
  run_command->add_option("--out", options.out, "write trajectory, plot and summary files into this folder");
  run_command->add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
  CLI::App* list_command = app.add_subcommand("list", "list the systems a scene can name");

  try {
    app.parse(argc, argv);
    if (list_command->parsed()) return list();
    if (run_command->parsed()) return run(options);
    return refuse(options, exit_bad_input, "invalid_command_line", "name a command, run or list; see lagroid --help");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    // The flag may not have been read before the mistake was met.
    for (int i = 1; i < argc; ++i) options.json = options.json || std::string_view(argv[i]) == "--json";
    return refuse(options, exit_bad_input, "invalid_command_line", fmt::format("{}; see lagroid --help", error.what()));
  } catch (const OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    return refuse(options, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; lower time.steps{}", options.scene,
                              options.out ? " or raise output.every" : ""));
  } catch (const std::exception& error) {
    return refuse(options, exit_internal_error, "internal_error",
                  fmt::format("internal error: {}; please report it with the scene", error.what()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  // What Ceres would say on standard error stands in its summary too, and is judged anew from the residual.
  FLAGS_minloglevel = google::GLOG_FATAL;
  try {
    return serve(argc, argv);
  } catch (const OutputError& error) {
    fmt::print(stderr, "lagroid: {}\n", error.what());
    return exit_failed;
  }
}
