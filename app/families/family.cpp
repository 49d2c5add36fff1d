#include "family.hpp"

#include <fmt/format.h>

#include <utility>

namespace lagroid::app {

MotionScene SceneFamily::read(const Section& scene, const RunContext&) const { refuse(scene); }

RunResult SceneFamily::run(const Section& scene, const RunContext& context) const {
  const MotionScene read_scene = read(scene, context);
  RunResult result;
  drive(*read_scene.motion, read_scene.extent, context, result);
  return result;
}

void SceneFamily::refuse(const Section& scene) const {
  scene.fail("", fmt::format("is no motion: lagroid {0} carries it out (in Python, lagroid.{0}); give a scene with "
                             "[initial] or [boundary]",
                             command()));
}

namespace {

std::vector<const SceneFamily*>& known_families() {
  static std::vector<const SceneFamily*> families;
  return families;
}

}  // namespace

std::span<const SceneFamily* const> families() { return known_families(); }
void use_families(std::vector<const SceneFamily*> families) { known_families() = std::move(families); }

const SceneFamily& family_of(const Section& scene) {
  const auto all = families();
  for (auto family = all.rbegin(); family != all.rend(); ++family)
    if ((*family)->recognises(scene)) return **family;
  return systems_family();
}

const SceneFamily& motions_of(const Section& scene) {
  const SceneFamily& family = family_of(scene);
  if (family.command() != "run") family.refuse(scene);
  return family;
}

void require_command(const Section& scene, std::string_view command) {
  const SceneFamily& family = family_of(scene);
  if (family.recognises(scene) && family.command() != command)
    scene.fail("", fmt::format("is no scene of lagroid {0}: lagroid {1} carries it out (in Python, lagroid.{1})",
                               command, family.command()));
}

}  // namespace lagroid::app
