#pragma once
/// Running scenes of bodies.

#include "../run_result.hpp"
#include "../task.hpp"

#include <limits>

namespace lagroid::app {

class Section;

/// Reads a scene of [[body]], [[joint]] and [[effect]] and runs it, over `most_steps` at most.
RunResult run_bodies(const Section& scene, const RunContext& context,
                     long most_steps = std::numeric_limits<long>::max());

}  // namespace lagroid::app
