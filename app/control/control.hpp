#pragma once
/// `lagroid control`: solves the optimal control problem of a scene.

#include "../command/command.hpp"

#include <optional>
#include <string>

namespace lagroid::app {

struct ControlCommandOptions : SceneOptions {
  std::optional<std::string> out;
  bool list = false;
};

/// SCENE, --set, --json, --out and --list.
void add_control_options(CLI::App& command, ControlCommandOptions& options);

/// Returns the exit code. Throws SceneError and OutputError.
int control(const ControlCommandOptions& options);

}  // namespace lagroid::app
