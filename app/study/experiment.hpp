#pragma once
/// A scene to be run by many methods with many steps.

#include "../reading/method.hpp"
#include "../reading/scene_reader.hpp"

#include <lagroid/run/motion.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

struct Experiment {
  std::string name;                             ///< of the system or the scene
  double end = 0;                               ///< the time that the scene lasts, s
  double step = 0;                              ///< its own step
  std::vector<Method> methods;                  ///< all that apply
  Section scene;                                ///< without what chooses the method
  std::function<bool()> interrupted = nullptr;  ///< asked now and then, where there is somebody to ask

  bool stopped() const { return interrupted && interrupted(); }

  /// From the scene's start. Throws SceneError where the method refuses this step.
  std::unique_ptr<Motion> begin(const Method& method, double h) const;
};

/// Of an initial-value scene; throws SceneError for others.
Experiment read_experiment(const Section& scene);

/// The scene, to be run by that method and with that step.
Section with_method(const Section& scene, const Method& method, double h, double end);

}  // namespace lagroid::app
