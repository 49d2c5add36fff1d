#pragma once
/// `lagroid new`: a folder to begin a system or a groupoid of one's own with.

#include "../command/program_command.hpp"

namespace lagroid::app {

ProgramCommand new_command();

}  // namespace lagroid::app
