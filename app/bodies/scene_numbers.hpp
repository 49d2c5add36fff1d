#pragma once
/// Numbers of a scene of bodies that may become others on its way.

#include "../reading/scene_reader.hpp"
#include "scene_bodies.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

/// A number that changes along with another: where it stands, what it is in the scene, and how much it changes by one.
struct SharedChange {
  std::string path;
  double value;
  double rate;
  bool operator==(const SharedChange&) const = default;
};

/// By a name and where it stands in the scene: spring.stiffness at effect.0.stiffness. Or of what stands in several
/// places, with no path of its own.
struct SceneNumber {
  std::string name;
  std::string path;
  double value;
  double given = 0;  ///< of what stands in several places: what it is in the scene
  std::vector<SharedChange> shared = {};
  bool operator==(const SceneNumber&) const = default;

  /// What varies in the scene, and how, where this number is one with derivatives.
  std::vector<VariedAt> varied(const VariedNumber& number) const;
};

/// All that tables with a name give: numbers of joints and effects, masses and inertias of bodies; of arrays each entry
/// by its place, weight.acceleration.2.
std::vector<SceneNumber> numbers_of_scene(const Section& scene);

/// All that derivatives are taken by: those, lengths of chains, centres of bodies, points of joints and effects, and
/// those of tables without a name, by where they stand, effect.0.motion.
std::vector<SceneNumber> numbers_to_differentiate(const Section& scene);

/// Where joints are, as `hinge.place.0`: x, y, z in space of the first's point at the start, with which the second's
/// goes, while the bodies stay. Of joints between points that the scene gives.
std::vector<SceneNumber> places_of_joints(const Section& scene, const SceneBodies& bodies);

/// The scene with what nature is taken to have where nothing is said: gravity, its constant, Coulomb's; and with the
/// pivots of bodies at the origin.
Section with_constants(const Section& scene);

/// The scene with these in their places.
Section scene_with(const Section& scene, const std::vector<SceneNumber>& numbers);

}  // namespace lagroid::app
