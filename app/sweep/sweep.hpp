#pragma once
/// `lagroid sweep`: many members of one scene, on all threads and on many machines.

#include "../command/program_command.hpp"

#include <string>

namespace lagroid::app {

struct SweepOptions : SceneOptions {
  std::string out;
  int threads = 0;           ///< 0: all that are available
  bool other_build = false;  ///< go on with parts that another build of lagroid ran
};

void add_sweep_options(CLI::App& command, SweepOptions& options);

/// Returns the exit code. Throws SceneError for mistakes in the sweep or its scene.
int sweep(const SweepOptions& options);

/// The command, for programs that have it.
ProgramCommand sweep_command();

}  // namespace lagroid::app
