#pragma once
/// `check` of a program of one's own (own_program.hpp).

#include "../check/family_laws.hpp"
#include "own_parts.hpp"

namespace lagroid::app {

/// Serves a command line of `check` for the systems. Returns the exit code.
int own_check_program(int argc, char** argv, OwnSystems systems, AskLaws ask);

}  // namespace lagroid::app
