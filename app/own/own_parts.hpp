#pragma once
/// What programs of one's own are made of, beside their systems.

#include "../scenes/system_module.hpp"

#include <string>
#include <typeinfo>
#include <vector>

namespace lagroid::app {

/// Serves a command line for the systems: commands that all programs have, and sweeps.
int own_program(int argc, char** argv, std::vector<const SystemModule*> systems);

/// A scene asks for more than a program of steps alone has. (Not a std::exception: it is no mistake of anybody's.)
struct NeedsAllMethods {};
/// Tells who started this program (run_source.hpp) that the one with all methods is needed. Returns the exit code.
int ask_for_all_methods();
/// The variable that names the file in which it is told.
inline constexpr const char* where_to_ask = "LAGROID_ASK_FOR_ALL_METHODS";

/// The class's name as scenes spell it: of lagroid::SpringPendulum, spring_pendulum.
std::string snake_case(const std::type_info& type);

}  // namespace lagroid::app
