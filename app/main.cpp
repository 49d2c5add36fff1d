/// The command line.

#include "output.hpp"
#include "registry.hpp"
#include "report.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace lagroid::app;

constexpr int exit_bad_input = 2;
constexpr int exit_failed = 3;

struct RunOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<std::string> out;
  bool json = false;
};

int refuse(const RunOptions& options, const std::string& message, const std::string& status = "invalid_scene") {
  fmt::print(stderr, "lagroid: {}\n", message);
  if (options.json) fmt::print("{}\n", json_error(status, message));
  return exit_bad_input;
}

int run(const RunOptions& options) {
  RunResult result;
  try {
    const Section scene = read_scene(options.scene, options.overrides);
    if (options.out) require_writable(*options.out);
    result = run_scene(scene, {.record = options.out.has_value(), .progress = !options.json});
  } catch (const SceneError& error) {
    return refuse(options, error.what());
  } catch (const OutputError& error) {
    return refuse(options, error.what());
  }
  std::vector<std::filesystem::path> files;
  if (options.out) {
    try {
      files = write_outputs(result, *options.out);
    } catch (const OutputError& error) {
      result.status = "output_failed";
      result.message = error.what();
      fmt::print(stderr, "lagroid: {}\n", error.what());
      fmt::print("{}\n", options.json ? json_report(result) : text_report(result));
      return exit_failed;
    }
  }
  if (options.json) {
    fmt::print("{}\n", json_report(result));
  } else {
    fmt::print("{}", text_report(result));
    for (const auto& file : files) fmt::print("  wrote {}\n", file.string());
    if (!options.out) fmt::print("  (no files written; --out DIR writes trajectory, plot and summary)\n");
  }
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "lagroid: standard output could not be written\n");
    return exit_failed;
  }
  if (!result.converged()) {
    fmt::print(stderr, "lagroid: {}: {}\n", options.scene, result.message);
    return exit_failed;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"lagroid: discrete mechanics on Lie groupoids"};
  app.require_subcommand(1);
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
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    // The flag may not have been read before the mistake was met.
    for (int i = 1; i < argc; ++i) options.json = options.json || std::string_view(argv[i]) == "--json";
    return refuse(options, fmt::format("{}; see lagroid --help", error.what()), "invalid_command_line");
  }
  try {
    if (list_command->parsed()) {
      for (const auto& entry : systems()) fmt::print("{:<20} {}\n", entry.name, entry.summary);
      return 0;
    }
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "lagroid: internal error: {}; please report it with the scene\n", error.what());
    if (options.json) fmt::print("{}\n", json_error("internal_error", error.what()));
    return 1;
  }
}
