#pragma once
/// Commands that a program may have or not.
///
///     const ProgramCommand learn = command_of("learn", "fits a Hamiltonian to trajectories", add_options, run_learn);

#include "command.hpp"

#include <concepts>
#include <functional>
#include <memory>
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

/// The command of a function, and of one that declares its options.
template <class Options>
ProgramCommand command_of(const std::string& name, const std::string& description, void (*add)(CLI::App&, Options&),
                          int (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  return {name,
          [=](CLI::App& program) {
            CLI::App* command = program.add_subcommand(name, description);
            add(*command, *options);
            return command;
          },
          [=](SceneOptions& told) {
            if constexpr (std::derived_from<Options, SceneOptions>) {
              told = *options;
            } else if constexpr (requires { options->json; }) {
              told.json = options->json;
            }
            return run(*options);
          }};
}

}  // namespace lagroid::app
