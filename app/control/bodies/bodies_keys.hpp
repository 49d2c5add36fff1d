#pragma once
/// A scene of bodies of which effects are controlled, as it is written: the tables of a scene that runs, and
/// [[actuator]], [[end]], [[constraint]], [horizon] and [solver].
///
///     const BodiesControl read = read_controlled_bodies(scene);
///     multibody::ControlledScene controlled(read.task);

#include "../../bodies/scene_bodies.hpp"
#include "../../keys/key.hpp"
#include "../search_keys.hpp"

#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

struct BodiesControl {
  multibody::SceneControl task;
  multibody::SceneSearchOptions search;
  ControlMethod method = ControlMethod::interior_point;
  std::vector<NamedBody> bodies;
  /// What the parts of task.end ask for, one for each: of turns one for all three numbers.
  struct EndWords {
    std::vector<std::string> places, turns, velocities, turnings;
  };
  EndWords end;
};

/// Throws SceneError.
BodiesControl read_controlled_bodies(const Section& scene);
std::vector<Key> controlled_bodies_keys();

}  // namespace lagroid::app
