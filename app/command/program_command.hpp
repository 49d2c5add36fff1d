#pragma once
/// Commands that a program may have or not; command_of.hpp makes one of a function.

#include "command.hpp"

#include <functional>
#include <optional>
#include <string>

namespace lagroid::app {

/// A command that is compiled into programs that name it.
struct ProgramCommand {
  std::string name;
  /// Adds it to the program's command line; the CLI::App returned is parsed where the command was given.
  std::function<CLI::App*(CLI::App& program)> add;
  /// Executes it. `told` is set to what messages need: the scene, and whether they are to be JSON.
  std::function<int(SceneOptions& told)> run;
  /// Executes a scene that `lagroid run` was given but is this command's; null where there are none.
  std::function<int(const SceneOptions& scene, const std::optional<std::string>& out)> run_scene = nullptr;
};

}  // namespace lagroid::app
