#pragma once
/// All that the library has, as parts of a program.

#include "program.hpp"

namespace lagroid::app {

ProgramParts whole_program();

}  // namespace lagroid::app
