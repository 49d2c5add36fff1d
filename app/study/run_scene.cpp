#include "run_scene.hpp"

#include "../families/registry.hpp"
#include "accuracy.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  if (!scene.has("accuracy")) return run_as_written(scene, context);
  const AccuracyChoice choice = choose_by_accuracy(scene);
  RunResult result = run_as_written(choice.scene, context);
  result.notes.insert(result.notes.begin(), choice.notes.begin(), choice.notes.end());
  return result;
}

}  // namespace lagroid::app
