#include "bodies_laws.hpp"

#include <lagroid/systems/multibody/testing/scene_control_laws.hpp>

#include <algorithm>

namespace lagroid::app {

Certificate certificate_of(multibody::ControlledScene& scene, const multibody::SceneSearchOptions& search,
                           const multibody::SceneSolver& solve, int samples, std::uint64_t seed) {
  const multibody::SceneSearch found = search_scene(
      scene, search, [](int) { return true; }, solve);
  Certificate out;
  out.samples = samples;
  out.seed = long(seed);
  multibody::SceneTranscription bent(scene, scene_guess(scene, 3, search));
  out.suites.push_back(laws::transcription_laws(bent, std::min(samples, 5), seed));
  const multibody::SceneSolution& best = found.minima.empty() ? found.best_failure : found.minima.front();
  out.states = best.path.nodes.size();
  if (best.report.converged()) {
    out.suites.push_back(laws::scene_control_laws(scene, best, search.solver, samples, seed));
  } else {
    out.failure = best.report.message;
    out.failure_status = to_string(best.report.status);
  }
  return out;
}

}  // namespace lagroid::app
