#pragma once
/// Running scenes of bodies.

#include "../run_result.hpp"
#include "../task.hpp"

namespace lagroid::app {

class Section;

/// Reads a scene of [[body]], [[joint]] and [[effect]] and runs it.
RunResult run_bodies(const Section& scene, const RunContext& context);

}  // namespace lagroid::app
