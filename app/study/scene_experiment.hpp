#pragma once
/// Scenes to be integrated by many methods with many steps.

#include "../reading/scene_reader.hpp"

#include <lagroid/run/study/experiment.hpp>

namespace lagroid::app {

/// Of an initial-value scene; throws SceneError for others.
Experiment read_experiment(const Section& scene);

/// The scene without what chooses the method, with a step and a number of steps.
Section without_method(const Section& scene);
/// The scene, to be run by that method and with that step.
Section with_method(const Section& scene, const Method& method, double h, double end);

}  // namespace lagroid::app
