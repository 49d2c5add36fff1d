#include "family.hpp"

#include <fmt/format.h>

#include <array>
#include <ranges>

namespace lagroid::app {

MotionScene SceneFamily::read(const Section& scene, const RunContext&) const { refuse(scene); }

RunResult SceneFamily::run(const Section& scene, const RunContext& context) const {
  const MotionScene read_scene = read(scene, context);
  RunResult result;
  drive(*read_scene.motion, read_scene.pace, context, result);
  return result;
}

void SceneFamily::refuse(const Section& scene) const {
  scene.fail(
      "", fmt::format("is no motion: lagroid {} carries it out; give a scene with [initial] or [boundary]", command()));
}

std::span<const SceneFamily* const> families() {
  static const std::array<const SceneFamily*, 5> all{&systems_family(), &spheres_family(), &bodies_family(),
                                                     &optimisation_family(), &sweeps_family()};
  return all;
}

const SceneFamily& family_of(const Section& scene) {
  for (const SceneFamily* family : std::views::reverse(families()))
    if (family->recognises(scene)) return *family;
  return systems_family();
}

const SceneFamily& motions_of(const Section& scene) {
  const SceneFamily& family = family_of(scene);
  if (family.command() != "run") family.refuse(scene);
  return family;
}

}  // namespace lagroid::app
