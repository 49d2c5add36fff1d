#pragma once
/// What acts at a node of a scene, in the order of its factors: its own forces, those of each control at strength one,
/// and the joints with their gradients,
///
///     f(q),    B_j(q),    C(q),    D(q) = dC(q).
///
/// A detail of ControlledScene. Over numbers with derivatives they are those along whatever the places and attitudes
/// are varied by. Linear factors come first, three numbers each, then rotations in the bodies' frames. No allocation
/// after construction; nothing throws.

#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <vector>

namespace lagroid::multibody {

template <class S> class NodeForces {
 public:
  using Vec3 = Vector<S, 3>;
  using Mat3 = Matrix<S, 3, 3>;

  /// Of the controls that switch these (numbers of BasicModel::switches), and the joints' rows of these numbers.
  NodeForces(BasicScene<S> scene, const std::vector<int>& controls, const std::vector<int>& rows);

  int linear() const { return int(model_.factors.inertia.size()); }
  int rotations() const { return int(model_.factors.moments.size()); }
  int size() const { return 3 * (linear() + rotations()); }

  /// Whose places of linear factors, the first ones, and attitudes are to be set.
  BasicConfiguration<S>& configuration() { return at_; }
  const Vec3& place(int linear) const { return at_.x[std::size_t(linear)]; }
  const Mat3& attitude(int rotation) const { return at_.attitude[std::size_t(rotation)]; }
  void evaluate();

  const S& own(int i) const { return own_[std::size_t(i)]; }
  const S& of_control(int control, int i) const { return of_controls_[std::size_t(control * size() + i)]; }
  const S& joint(int row) const { return joints_[std::size_t(row)]; }
  const S& gradient(int row, int i) const { return gradients_[std::size_t(row * size() + i)]; }
  /// Of sites, attitudes and linear factors as they are numbered in the scene that was written.
  const Vec3& operator()(Site site) const { return at_(model_.places(site)); }
  const Mat3& operator()(Attitude attitude) const { return at_(model_.places(attitude)); }
  /// How fast a point moves where factors have these velocities, W (mu - D^T nu).
  Vec3 velocity(Site site, const std::vector<S>& velocities) const {
    return velocity_at(model_.places(site).index, velocities);
  }
  int place_of(int linear) const { return model_.linear_places[std::size_t(linear)]; }
  int place_of(Attitude attitude) const { return model_.places(attitude).index; }

 private:
  void act(const std::vector<char>& on, S* out);
  Vec3 velocity_at(int point, const std::vector<S>& velocities) const;

  BasicModel<S> model_;
  BasicConfiguration<S> at_;
  BasicLoads<S> loads_;
  std::vector<char> on_;                 // without controls
  std::vector<std::vector<char>> only_;  // each control alone
  std::vector<int> row_of_;              // of each row of the model; -1: it is off
  std::vector<Vec3> at_rest_, joint_gradients_;
  std::vector<RowSize> row_sizes_;
  std::vector<S> values_, own_, of_controls_, joints_, gradients_;
};

}  // namespace lagroid::multibody
