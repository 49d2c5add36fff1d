#include "registry.hpp"

#include "scenes/scene_run.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  if (scene.has("body")) return run_bodies(scene, context);
  return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
}

}  // namespace lagroid::app
