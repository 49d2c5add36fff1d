#pragma once
/// What the dampers of a scene put on both ends of an arrow g from q to q', as discrete forces, whatever the step,
///
///     f-(g) = -sum_r c_r phi_r(g) omega_r(q) / 2,    f+(g) = -sum_r c_r phi_r(g) omega_r(q') / 2,
///
/// phi_r the change of what damper r measures and omega_r the covectors of its reaction: those of the steps of
/// Multibody, whose multipliers of dampers are solved for. In the order of NodeForces. A detail of ControlledScene,
/// over any scalar. Requires turns below a half one. No allocation after construction; nothing throws.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <vector>

namespace lagroid::multibody {

template <class S> class DamperForces {
 public:
  using Vec3 = Vector<S, 3>;

  /// Of the dampers that are on (BasicModel::switches).
  DamperForces(BasicScene<S> scene, const std::vector<char>& on);

  int linear() const { return int(model_.factors.inertia.size()); }
  int size() const { return 3 * (linear() + int(model_.factors.moments.size())); }
  int rows() const { return int(rows_.size()); }
  /// The factors that are pushed.
  const std::vector<int>& factors() const { return factors_; }

  /// Whose places of linear factors, the first ones, and attitudes are to be set.
  BasicConfiguration<S>& configuration(End end) { return at_[std::size_t(end)].configuration; }
  void evaluate();

  /// f- or f+.
  const S& operator()(End end, int i) const { return at_[std::size_t(end)].force[std::size_t(i)]; }
  /// omega_r.
  const S& covector(End end, int row, int i) const {
    return at_[std::size_t(end)].covectors[std::size_t(row * size() + i)];
  }

 private:
  struct Node {
    BasicConfiguration<S> configuration;
    std::vector<S> covectors, force;
  };

  void react(Node& node);

  BasicModel<S> model_;
  Node at_[2];               // End
  std::vector<int> rows_;    // of the model
  std::vector<int> row_of_;  // of each row of the model; -1: it is no damper's
  std::vector<int> factors_;
  std::vector<Vec3> displacements_, turns_, gradients_;
  std::vector<RowSize> row_sizes_;
  std::vector<S> values_;
};

}  // namespace lagroid::multibody
