#pragma once
/// Running scenes.

#include "../reading/scene_reader.hpp"

#include <lagroid/run/motion/drive.hpp>

namespace lagroid::app {

/// Runs the scene, by the method and the step that it names or that `choose_by_accuracy` finds.
RunResult run_scene(const Section& scene, const RunContext& context);

}  // namespace lagroid::app
