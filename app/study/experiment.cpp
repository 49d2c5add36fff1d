#include "experiment.hpp"

#include "../families/family.hpp"
#include "../reading/simulation.hpp"

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

}  // namespace

Section with_method(const Section& scene, const Method& method, double h, double end) {
  std::vector<std::string> settings = method.settings;
  settings.push_back(fmt::format("time.step={:.17e}", h));
  settings.push_back(fmt::format("time.steps={}", std::max(1L, std::lround(end / h))));
  return scene.set(settings);
}

std::unique_ptr<Motion> Experiment::begin(const Method& method, double h) const {
  const Section by_method = with_method(scene, method, h, end);
  return family_of(by_method).begin(by_method).motion;
}

Experiment read_experiment(const Section& scene) {
  Experiment out;
  const SceneFamily& family = motions_of(scene);
  const TimeGrid grid = read_time(scene);
  out.step = grid.step;
  out.end = grid.step * double(grid.steps);
  out.scene = without_choice(scene)
                  .without("time.duration")
                  .set({fmt::format("time.step={:.17e}", grid.step), fmt::format("time.steps={}", grid.steps)});
  MotionScene begun = family.begin(out.scene);
  out.name = begun.motion->name();
  out.methods = std::move(begun.methods);
  return out;
}

}  // namespace lagroid::app
