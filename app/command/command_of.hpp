#pragma once
/// A command that a program may have, of the function that carries it out.
///
///     const ProgramCommand learn = command_of("learn", "fits a Hamiltonian to trajectories", add_options, run_learn);

#include "program_command.hpp"

#include <CLI/CLI.hpp>

#include <concepts>
#include <memory>
#include <string>

namespace lagroid::app {

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
