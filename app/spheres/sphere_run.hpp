#pragma once
/// Scenes on (T*S^2)^k as motions.

#include <lagroid/run/study/method.hpp>
#include "sphere_system.hpp"

#include <lagroid/run/drive.hpp>
#include <lagroid/run/motion.hpp>

#include <memory>
#include <vector>

namespace lagroid::app {

/// A scene whose steps are to be asked their laws.
struct SpheresToCheck {
  std::shared_ptr<const SphereSystem> system;
  SphereMarchOptions options;
  SphereMarch::Points start;  ///< in the form of the options
};

/// A scene that has been read.
struct SphereScene {
  std::unique_ptr<Motion> motion;
  Pace pace;
  std::vector<Method> methods;  ///< by which it could be marched
  SpheresToCheck to_check;
};
SphereScene read_spheres(const SphereEntry& entry, const Section& scene, const RunContext& context);

}  // namespace lagroid::app
