#pragma once
/// The subjects of `lagroid gradient` by the systems of a program: each is compiled by itself, and asked in turn
/// whether a scene's module is its own.
///
///     return gradient_program(argc, argv, {{&systems_family()}, {&kepler_module()}, {}}, {kepler_gradient});

#include "../program.hpp"
#include "../scenes/system_module.hpp"
#include "gradient_subject.hpp"

#include <optional>
#include <vector>

namespace lagroid::app {

/// Of a scene of the module's system; nothing where that is another system.
using AskGradient = std::optional<GradientSubject> (*)(const SystemModule& module, const Section& scene);

/// Serves a command line of `lagroid gradient`. Returns the exit code.
int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects);

}  // namespace lagroid::app
