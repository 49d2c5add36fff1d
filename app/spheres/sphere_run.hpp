#pragma once
/// Scenes on (T*S^2)^k as motions.

#include "../scenes/motion_scene.hpp"
#include "sphere_system.hpp"

#include <memory>

namespace lagroid::app {

/// A scene whose steps are to be asked their laws.
struct SpheresToCheck {
  std::shared_ptr<const SphereSystem> system;
  SphereIntegratorOptions options;
  SphereIntegrator::Points start;  ///< in the form of the options
};

/// A scene that has been read.
struct SphereScene : MotionScene {
  SpheresToCheck to_check;
};
SphereScene read_spheres(const SphereEntry& entry, const Section& scene, const RunContext& context);

}  // namespace lagroid::app
