#pragma once
/// A program: the commands that all programs have, and the families, systems and further commands that this one is
/// given.
///
///     return program(argc, argv, {.families = {&systems_family()}, .systems = {&pendulum}, .commands = {}});
///
/// Requires that all of them outlive the call. Returns the exit code; what goes wrong is one line on standard error.

#include "command/program_command.hpp"
#include "families/family.hpp"
#include "scenes/system_module.hpp"

#include <vector>

namespace lagroid::app {

/// What a program is made of, beside the commands run, resume, view, plot, study, check, list, schema and cite.
struct ProgramParts {
  std::vector<const SceneFamily*> families;  ///< in the order in which their systems are listed
  std::vector<const SystemModule*> systems;
  std::vector<ProgramCommand> commands;
};

/// Serves a command line. Returns the exit code.
int program(int argc, char** argv, ProgramParts parts);

}  // namespace lagroid::app
