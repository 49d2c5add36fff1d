#pragma once
/// What commands have in common: the scene on the command line, what is printed, and how they end.
///
/// A mistake of the user's is one line and an exit code, never a stack of exceptions.
///
///     if (!scene_exists) return refuse(options.json, exit_bad_input, "invalid_scene", "scene: no such file");
///     print(text_report(result));
///
/// Returns exit codes: `exit_bad_input`, `exit_failed`, `exit_interrupted`, `exit_internal_error`, or 0.

#include "parser.hpp"

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

/// Writes in one line on standard error what went wrong. Where that is closed or full, nothing is written.
void complain(const std::string& message);

/// Ends a command that has no result: one line, and one JSON object where `json` is set. Returns `code`.
int refuse(bool json, int code, const std::string& status, const std::string& message);

/// Reads the command line with the named `app`, then serves it. What goes wrong becomes one line and an exit code.
int command_line(CLI::App& app, int argc, char** argv, SceneOptions& options, const std::function<int()>& serve);

}  // namespace lagroid::app
