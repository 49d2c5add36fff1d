#pragma once
/// `lagroid optimize`: minimises the function of a scene on its manifold.

#include "../command/command.hpp"

#include <optional>
#include <string>

namespace lagroid::app {

struct OptimiseOptions : SceneOptions {
  std::optional<std::string> out;
  bool list = false;
};

/// SCENE, --set, --json, --out and --list.
void add_optimise_options(CLI::App& command, OptimiseOptions& options);

/// Returns the exit code. Throws SceneError and OutputError.
int optimise(const OptimiseOptions& options);

}  // namespace lagroid::app
