#include "registry.hpp"

#include "scenes/scene_run.hpp"
#include "spheres/sphere_run.hpp"
#include "study/accuracy.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  if (scene.has("accuracy")) {
    const AccuracyChoice choice = choose_by_accuracy(scene);
    RunResult result = run_scene(choice.scene, context);
    result.notes.insert(result.notes.begin(), choice.notes.begin(), choice.notes.end());
    return result;
  }
  if (scene.has("body")) return run_bodies(scene, context);
  if (const SphereEntry* spheres = sphere_system_of(scene)) return run_spheres(*spheres, scene, context);
  return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
}

}  // namespace lagroid::app
