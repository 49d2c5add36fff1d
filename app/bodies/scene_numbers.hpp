#pragma once
/// Numbers of a scene of bodies that may become others on its way.

#include "../reading/scene_reader.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

/// By a name and where it stands in the scene: spring.stiffness at effect.0.stiffness.
struct SceneNumber {
  std::string name;
  std::string path;
  double value;
  bool operator==(const SceneNumber&) const = default;
};

/// All that tables with a name give: numbers of joints and effects, masses and inertias of bodies; of arrays each entry
/// by its place, weight.acceleration.2.
std::vector<SceneNumber> numbers_of_scene(const Section& scene);

/// All that derivatives are taken by: those, lengths of chains, centres of bodies, points of joints and effects, and
/// those of tables without a name, by where they stand, effect.0.motion.
std::vector<SceneNumber> numbers_to_differentiate(const Section& scene);

/// The scene with these in their places.
Section scene_with(const Section& scene, const std::vector<SceneNumber>& numbers);

}  // namespace lagroid::app
