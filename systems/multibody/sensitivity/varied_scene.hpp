#pragma once
/// A scene over numbers with derivatives: the equations of its step, and what is seen at its nodes.
///
///     E: F-_K(xi) + c xi / 2 - p - h f(q) / 2 - D(q)^T lambda = 0,    C(q g) = 0,    phi(g) = 0,
///     X: q' = q g,    p' = F+ of the same, with h f(q') / 2 and what dampers and vakonomic rows do at the target.
///
/// A detail of LinearisedScene. Masses, lengths, stiffness and all else that the scene is made of may vary with the
/// places, momenta, displacements and multipliers at once: what depends on what is left to the numbers. Nothing here
/// solves anything, so that values are those of a step that was solved.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

namespace lagroid::multibody {

using VariedVec = Vector<VariedNumber, 3>;
using VariedNumbers = Eigen::Matrix<VariedNumber, Eigen::Dynamic, 1>;
/// Along what a number is varied.
using VariedTangent = VariedNumber::Tangent;

/// What is seen of a scene at a node; places and momenta in the order of the model.
struct ObservedScene {
  const BasicModel<VariedNumber>& model;
  const BasicConfiguration<VariedNumber>& at;
  const std::vector<VariedVec>& momentum;  ///< of linear factors, tangent to the joints
  const std::vector<VariedVec>& spin;      ///< of rotations, in the bodies
  const std::vector<Vector<VariedNumber, 4>>& quaternions;
  VariedNumber kinetic, potential;

  const VariedVec& operator()(Site s) const { return at(model.places(s)); }
  const Matrix<VariedNumber, 3, 3>& operator()(Attitude a) const { return at(model.places(a)); }
  /// Of the linear factor that `Scene::linear_of` numbers.
  const VariedVec& momentum_of(int linear) const {
    return momentum[std::size_t(model.linear_places[std::size_t(linear)])];
  }
  const Vector<VariedNumber, 4>& quaternion(Attitude a) const {
    return quaternions[std::size_t(model.places(a).index)];
  }
  const VariedVec& spin_of(Attitude a) const { return spin[std::size_t(model.places(a).index)]; }
};

/// A scene that was written over numbers with derivatives.
struct WrittenScene {
  BasicScene<VariedNumber> scene;
  /// What is observed of it, null for nothing.
  std::function<VariedNumbers(const ObservedScene&)> observe = nullptr;
  /// Whether velocities of the start are brought to what the joints allow (Multibody::make_tangent).
  bool projects = false;
};

/// How many numbers a scene's step has of each kind, and where: states are (v, mu), v the displacements of linear
/// factors and the turns of rotations; unknowns are the arrow's and the multipliers of the rows that act.
struct SceneSizes {
  int linear = 0;
  int rotations = 0;
  std::vector<int> rows;      ///< that act and depend on no others
  std::vector<int> left_out;  ///< that act and do

  int n() const { return 3 * (linear + rotations); }
  int states() const { return 2 * n(); }
  int unknowns() const { return n() + int(rows.size()); }
  /// Of what is seen at a node, the directions: the states and the time.
  int directions() const { return states() + 1; }
};

/// A step that was solved.
struct SolvedStep {
  const SceneState& before;
  const std::vector<Vec>& displacements;
  const std::vector<Vec>& turns;
  const std::vector<double>& multipliers;
  double end;  ///< the time there
  double h;
};
/// From node to node, which must outlive it.
inline SolvedStep solved_step(const SceneState& before, const SceneState& after,
                              const std::vector<Vec>& displacements) {
  return {before, displacements, after.guess.turns, after.guess.multipliers[0], after.at.time, after.step};
}

class VariedScene {
 public:
  /// Requires a scene of the same bodies and joints as the motion's.
  VariedScene(WrittenScene written, const Multibody& motion);

  /// The equations of a step and its end, varied along the unknowns and the states from direction `first` on: unknowns
  /// first, then states. Past them, where `first` is beyond, by the numbers of this scene alone.
  void step(const SolvedStep& solved, const SceneSizes& sizes, int first);
  /// The same with a tangent for each unknown and then each state, and perhaps for the time of its start and its size.
  void step(const SolvedStep& solved, const SceneSizes& sizes, std::span<const VariedTangent> tangents);
  const VariedNumbers& equations() const { return equations_; }
  const VariedNumbers& end() const { return end_; }
  /// The equations of rows that depend on others, which hold with those.
  const VariedNumbers& left_out() const { return left_out_; }

  /// What is observed at a node, varied from direction `first` on along the states and, after them, the time there;
  /// past it by the numbers of this scene alone.
  VariedNumbers observe(const SceneState& node, const SceneSizes& sizes, int first);

  /// The momenta of a node without what the joints do not allow (Multibody::make_tangent), varied in the same way.
  VariedNumbers tangent_momenta(const SceneState& node, const SceneSizes& sizes, int first);
  /// The equations of the holonomic joints that act, at a node, and the rate of the time scale of controlled steps.
  VariedNumbers held_places(const SceneState& node, const SceneSizes& sizes, int first);
  VariedNumber time_scale_rate(const SceneState& node, const SceneSizes& sizes, int first);

  /// The start that the numbers of this scene make: displacement and momentum, of which the derivatives count.
  VariedNumbers start(const SceneSizes& sizes);
  /// What joints hold at that start: an equation, or the rate at which it is violated, and the size of its terms.
  struct Held {
    VariedNumber left;
    double size;
  };
  std::vector<Held> held(const SceneSizes& sizes);

 private:
  using V = VariedNumber;
  using Model = BasicModel<V>;
  using Role = multibody::Role;

  /// Tangents of so many numbers, unit ones of those from `first` on.
  std::span<const VariedTangent> unit_tangents(int count, int first);
  void place(const SceneState& node, const SceneSizes& sizes, std::span<const VariedTangent> tangents);
  void place_points(BasicConfiguration<V>& at) const;
  /// A node's, its states and its time varied from direction `first` on.
  void place(const SceneState& node, const SceneSizes& sizes, int first);
  void find_vakonomic_gradients(const BasicSceneArrow<V>& motion);
  /// Adds multipliers times gradients of the rows of which the role counts.
  template <class Counts>
  void react(const std::vector<V>& multipliers, const std::vector<VariedVec>& gradients, const Counts& counts,
             std::vector<VariedVec>& linear, std::vector<VariedVec>& spin) const;
  /// D times the velocities of these momenta, and what moves by itself.
  std::vector<V> rates(const std::vector<VariedVec>& linear, const std::vector<VariedVec>& spin, double h) const;
  /// Takes from the momenta what the rows do not allow.
  void project(const SceneSizes& sizes, double h, std::vector<VariedVec>& linear, std::vector<VariedVec>& spin);

  Model model_;
  BasicSceneState<V> start_;
  std::function<VariedNumbers(const ObservedScene&)> observe_;
  bool projects_;
  std::vector<VariedTangent> tangents_;

  BasicConfiguration<V> before_, after_;
  std::vector<Vector<V, 4>> quaternions_;  ///< of `before_`
  BasicLoads<V> loads_, next_loads_;
  std::vector<VariedVec> displacements_, turns_, momentum_, spin_, impulse_, spin_impulse_;
  std::vector<VariedVec> gradients_, next_gradients_, drifts_;
  std::vector<RowSize> row_sizes_;
  std::vector<V> multipliers_, values_;
  VariedNumbers equations_, end_, left_out_;
  Elimination projection_;            ///< D M^{-1} D^T
  std::vector<int> projection_rows_;  ///< of which it is: its pattern is theirs
};

/// The numbers of a motion's step.
SceneSizes sizes_of(const Multibody& motion);

}  // namespace lagroid::multibody
