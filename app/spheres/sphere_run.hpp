#pragma once
/// Running scenes on (T*S^2)^k.

#include "../task.hpp"
#include "sphere_system.hpp"

#include <lagroid/run/run_result.hpp>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

/// Reads such a scene and runs it, over `most_steps` at most.
RunResult run_spheres(const SphereEntry& entry, const Section& scene, const RunContext& context,
                      long most_steps = std::numeric_limits<long>::max());

/// The motion of a scene alone, and the methods by which it could be marched.
struct SphereTrialOf {
  std::unique_ptr<Trial> trial;
  std::vector<Method> methods;
};
SphereTrialOf begin_spheres(const SphereEntry& entry, const Section& scene);

/// A scene whose steps are to be asked their laws.
struct SpheresToCheck {
  std::shared_ptr<const SphereSystem> system;
  SphereMarchOptions options;
  SphereMarch::Points start;  ///< in the form of the options
};
SpheresToCheck spheres_to_check(const SphereEntry& entry, const Section& scene);

}  // namespace lagroid::app
