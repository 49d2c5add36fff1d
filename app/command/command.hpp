#pragma once
/// What the programs have in common: the scene on the command line, what is printed, how they end.

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

inline constexpr int exit_internal_error = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_failed = 3;
inline constexpr int exit_interrupted = 4;

struct SceneOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool json = false;
};

/// SCENE, --set and --json.
void add_scene_options(CLI::App& command, SceneOptions& options);

/// A number of an option, not NaN (which CLI::Range lets pass).
CLI::Validator between(double low, double high);

/// Whether --json stands anywhere on the command line.
bool asks_for_json(int argc, char** argv);

/// Prints on standard output what a terminal shows and does not obey (text.hpp), or throws OutputError.
void print(const std::string& text);

/// Says in one line on standard error what went wrong. Where that is closed or full nobody is told.
void complain(const std::string& message);

/// Ends a command that has no result: one line, and one JSON object where `json` is asked for. Returns `code`.
int refuse(bool json, int code, const std::string& status, const std::string& message);

/// Reads the command line with the named `app`, then serves it. What goes wrong becomes one line and an exit code.
int command_line(CLI::App& app, int argc, char** argv, SceneOptions& options, const std::function<int()>& serve);

}  // namespace lagroid::app
