#include "scene_experiment.hpp"

#include "../families/family.hpp"
#include "../scenes/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

constexpr std::array choosing{"time.mode",      "time.method",       "time.form",     "time.order", "time.composition",
                              "time.tolerance", "time.without_root", "time.accuracy", "accuracy"};

}  // namespace

Section with_method(const Section& scene, const Method& method, double h, double end) {
  std::vector<std::string> settings = method.settings;
  settings.push_back(fmt::format("time.step={:.17e}", h));
  settings.push_back(fmt::format("time.steps={}", std::max(1L, std::lround(end / h))));
  return scene.set(settings);
}

Section without_method(const Section& scene) {
  const TimeGrid grid = read_time(scene);
  Section plain = scene.without("time.duration");
  for (const char* key : choosing) plain = plain.without(key);
  return plain.set({fmt::format("time.step={:.17e}", grid.step), fmt::format("time.steps={}", grid.steps)});
}

Experiment read_experiment(const Section& scene) {
  for (const Event& event : read_events(scene))
    if (event.changes_motion() || event.then == Event::Then::stop)
      scene.fail("event", fmt::format("\"{}\" changes the motion or ends it, and methods are compared along all of it: "
                                      "leave out its kick, set and then",
                                      event.name));
  if (scene.has("noise"))
    scene.fail("noise",
               "has another path for every size of steps, so that no two of them have an error to compare: "
               "leave it out, or sweep over its paths");
  const SceneFamily& family = motions_of(scene);
  const TimeGrid grid = read_time(scene);
  const Section plain = without_method(scene);
  MotionScene begun = family.read(plain, {});
  Experiment out;
  out.name = begun.motion->name();
  out.step = grid.step;
  out.end = grid.step * double(grid.steps);
  out.methods = std::move(begun.methods);
  out.motion = [&family, plain](const Method& method, double h, double end) {
    try {
      return family.read(with_method(plain, method, h, end), {}).motion;
    } catch (const SceneError& error) {
      throw MethodRefused(error.problem());
    }
  };
  return out;
}

}  // namespace lagroid::app
