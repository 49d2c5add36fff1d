#pragma once
/// `gradient` and `fit` of a program of one's own (own_program.hpp).

#include "../gradient/system_gradients.hpp"
#include "own_parts.hpp"

#include <vector>

namespace lagroid::app {

/// Serves a command line of either for the systems, whose subjects are these. Returns the exit code.
int own_gradient_program(int argc, char** argv, OwnSystems systems, std::vector<AskGradient> subjects);

}  // namespace lagroid::app
