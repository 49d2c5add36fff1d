#include "experiment.hpp"

#include "../registry.hpp"
#include "../scenes/scene_run.hpp"
#include "../simulation.hpp"
#include "../spheres/sphere_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

constexpr std::array choosing{"time.mode",      "time.method",       "time.form",     "time.order", "time.composition",
                              "time.tolerance", "time.without_root", "time.accuracy", "accuracy"};

Section without_choice(Section scene) {
  for (const char* key : choosing) scene = scene.without(key);
  return scene;
}

/// The trial of a scene and the methods it could use.
struct Begun {
  std::string name;
  std::unique_ptr<Trial> trial;
  std::vector<Method> methods;
};
Begun begin_scene(const Section& scene) {
  if (scene.has("body")) {
    BodiesTrial bodies = begin_bodies(scene);
    return {bodies.name, std::move(bodies.trial), std::move(bodies.methods)};
  }
  if (const SphereEntry* entry = sphere_system_of(scene)) {
    SphereTrialOf spheres = begin_spheres(*entry, scene);
    return {std::string(entry->name), std::move(spheres.trial), std::move(spheres.methods)};
  }
  return with_system_of(scene, [&](const auto& entry) {
    const auto task = entry.read(scene, {});
    if (!task.begin)
      scene.fail("boundary", "a study compares how initial values are marched: give a scene with [initial]");
    return Begun{std::string(entry.name), task.begin(), task.methods};
  });
}

}  // namespace

Section with_method(const Section& scene, const Method& method, double h, double end) {
  std::vector<std::string> settings = method.settings;
  settings.push_back(fmt::format("time.step={:.17e}", h));
  settings.push_back(fmt::format("time.steps={}", std::max(1L, std::lround(end / h))));
  return scene.set(settings);
}

std::unique_ptr<Trial> Experiment::begin(const Method& method, double h) const {
  return begin_scene(with_method(scene, method, h, end)).trial;
}

Experiment read_experiment(const Section& scene) {
  Experiment out;
  const TimeGrid grid = read_time(scene);
  out.step = grid.step;
  out.end = grid.step * double(grid.steps);
  out.scene = without_choice(scene)
                  .without("time.duration")
                  .set({fmt::format("time.step={:.17e}", grid.step), fmt::format("time.steps={}", grid.steps)});
  Begun begun = begin_scene(out.scene);
  out.name = begun.name;
  out.methods = std::move(begun.methods);
  return out;
}

}  // namespace lagroid::app
