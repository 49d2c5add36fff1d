#pragma once
/// A scene of places alone over numbers with derivatives, as it is at one node after another: what effects and joints
/// give there, and the values of the joints.
///
///     VariedNode node(write(numbers).scene, h);  // numbers vary in the directions between
///     node.place(state, along, amounts);         // places along the one in the first direction, the other in the last
///     const auto& impulses = node.push();        // h f / 2
///     node.react(multipliers);                   // and D^T lambda
///
/// A detail of SceneAdjoint. Requires a scene in which nothing turns. Nothing throws.

#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/scene.hpp>
#include <lagroid/systems/multibody/sensitivity/varied_scene.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <vector>

namespace lagroid::multibody {

class VariedNode {
 public:
  VariedNode(BasicScene<VariedNumber> scene, double h);

  /// The masses, three a factor.
  const std::vector<VariedVec>& inertia() const { return model_.factors.inertia; }

  /// Goes to a node, with places that do not vary, or along two lists of displacements.
  void place(const SceneState& node);
  void place(const SceneState& node, const std::vector<Vec>& first, const std::vector<Vec>& last);

  /// Of all factors at this node.
  const std::vector<VariedVec>& push();
  const std::vector<VariedVec>& react(const std::vector<double>& multipliers);
  /// Of all rows, at a step that ends at this node.
  const std::vector<VariedNumber>& values();

 private:
  template <class TangentOf> void place(const SceneState& node, const TangentOf& of);
  /// The arrow from this node to itself, of which joints on places know the target alone.
  BasicSceneArrow<VariedNumber> stays() const { return {at_, at_, at_rest_, at_rest_, h_}; }

  BasicModel<VariedNumber> model_;
  double h_;
  BasicConfiguration<VariedNumber> at_;
  BasicLoads<VariedNumber> loads_;
  std::vector<VariedVec> impulses_, gradients_, at_rest_;
  std::vector<VariedNumber> values_;
};

}  // namespace lagroid::multibody
