#pragma once
/// Scenes of Poisson systems as motions.

#include "../scenes/motion_scene.hpp"
#include "poisson_entry.hpp"

#include <memory>
#include <vector>

namespace lagroid::app {

/// The keys of [initial] and of [time].
Table poisson_start_table(const PoissonEntry& entry);
Table poisson_time_table(const PoissonEntry& entry);
/// The method that [time] names, with its composition.
struct ReadMethod {
  const DeclaredMethod* declared;
  Composition composition;
};
ReadMethod read_poisson_method(const Section& time, const PoissonEntry& entry);

/// A scene whose steps are to be asked their laws.
struct PoissonToCheck {
  std::shared_ptr<const AnyPoissonSystem> system;
  PoissonOptions options;
  std::vector<double> start;
};
/// A scene that has been read.
struct PoissonScene : MotionScene {
  PoissonToCheck to_check;
};
PoissonScene read_poisson(const PoissonEntry& entry, const Section& scene, const RunContext& context);

}  // namespace lagroid::app
