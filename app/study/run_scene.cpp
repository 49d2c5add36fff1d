#include "run_scene.hpp"

#include "../families/family.hpp"
#include "accuracy.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  if (!scene.has("accuracy")) return family_of(scene).run(scene, context);
  const AccuracyChoice choice = choose_by_accuracy(scene);
  RunResult result = family_of(choice.scene).run(choice.scene, context);
  result.notes.insert(result.notes.begin(), choice.notes.begin(), choice.notes.end());
  return result;
}

}  // namespace lagroid::app
