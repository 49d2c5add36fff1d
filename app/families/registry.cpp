#include "registry.hpp"

#include "../bodies/scene_run.hpp"
#include "../spheres/sphere_run.hpp"

namespace lagroid::app {

namespace {

/// Of bodies or spheres.
template <class Read> RunResult run_motion(Read read, const RunContext& context) {
  RunResult result;
  drive(*read.motion, read.pace, context, result);
  return result;
}
template <class Read> MotionScene scene_of(Read read) { return {std::move(read.motion), std::move(read.methods)}; }

}  // namespace

RunResult run_as_written(const Section& scene, const RunContext& context) {
  if (scene.has("body")) return run_motion(read_bodies(scene, context), context);
  if (const SphereEntry* spheres = sphere_system_of(scene))
    return run_motion(read_spheres(*spheres, scene, context), context);
  return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
}

MotionScene begin_scene(const Section& scene) {
  if (scene.has("body")) return scene_of(read_bodies(scene, {}));
  if (const SphereEntry* spheres = sphere_system_of(scene)) return scene_of(read_spheres(*spheres, scene, {}));
  return with_system_of(scene, [&](const auto& entry) {
    const auto task = entry.read(scene, {});
    if (!task.begin)
      scene.fail("boundary", "a study compares how initial values are marched: give a scene with [initial]");
    return MotionScene{task.begin(), task.methods};
  });
}

}  // namespace lagroid::app
