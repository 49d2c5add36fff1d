#pragma once
/// From a scene as it was written to the arrays that its steps run over: sites are numbered, islands found, and their
/// matrices prepared.

#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/scene.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <vector>

namespace lagroid::multibody {

template <class S = double> struct BasicAssembled {
  BasicModel<S> model;
  BasicSceneState<S> start;           ///< but for what follows from places and attitudes
  std::vector<Elimination> matrices;  ///< of the islands
};
using Assembled = BasicAssembled<>;

/// The arrays that steps of the size h run over. Joints that touch nothing that moves are left out. Throws
/// std::domain_error where one island obeys two principles.
template <class S> BasicAssembled<S> assemble(BasicScene<S> scene, double h);

}  // namespace lagroid::multibody
