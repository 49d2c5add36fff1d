#pragma once
/// The program lagroid-check: `lagroid check`.

#include "../program.hpp"
#include "family_laws.hpp"

#include <vector>

namespace lagroid::app {

/// Serves its command line, of scenes of these parts by these laws. Returns the exit code.
int check_program(int argc, char** argv, ProgramParts parts, std::vector<const FamilyLaws*> laws);

}  // namespace lagroid::app
