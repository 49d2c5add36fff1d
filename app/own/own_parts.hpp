#pragma once
/// What programs of one's own are made of, beside their systems.

#include "../scenes/system_module.hpp"

#include <string>
#include <typeinfo>
#include <vector>

namespace lagroid::app {

struct PoissonEntry;

/// The systems of a program.
struct OwnSystems {
  std::vector<const SystemModule*> systems;   ///< on groupoids
  std::vector<const PoissonEntry*> brackets;  ///< on Poisson manifolds
};
/// Why they cannot be in one program, in a line; empty where they can.
std::string refusal_of(const OwnSystems& systems);
/// Serves a command line for them: commands that all programs have, and sweeps.
int own_program(int argc, char** argv, OwnSystems systems);

/// A scene needs more than a program of steps alone has. (Not a std::exception: it is no error, and no handler of
/// errors may catch it.)
struct NeedsAllMethods {};
/// Reports to the process that started this program (run_source.hpp) that the one with all methods is needed. Returns
/// the exit code.
int ask_for_all_methods();
/// The environment variable that names the file into which that is written.
inline constexpr const char* where_to_ask = "LAGROID_ASK_FOR_ALL_METHODS";

/// The class's name as scenes spell it: of lagroid::SpringPendulum, spring_pendulum.
std::string snake_case(const std::type_info& type);

}  // namespace lagroid::app
