#pragma once
/// From a scene as it was written to the arrays that its steps run over: sites are numbered, islands found, and their
/// matrices prepared.

#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/scene.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <vector>

namespace lagroid::multibody {

struct Assembled {
  Model model;
  SceneState start;                   ///< but for what follows from places and attitudes
  std::vector<Elimination> matrices;  ///< of the islands
};

/// The arrays that steps of the size h run over. Joints that touch nothing that moves are left out. Throws
/// std::domain_error where one island obeys two principles.
Assembled assemble(Scene scene, double h);

}  // namespace lagroid::multibody
