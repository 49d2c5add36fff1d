#pragma once
/// What a controlled scene is to satisfy at its end: its joints, and what is given of places, attitudes and velocities,
///
///     C(q) = 0,    x_i = given,    log(A_given^T A) = 0,    (W (mu - D^T nu))_i = given,    D W (mu - D^T nu) = 0,
///
/// W the inverse inertia. The momenta of a node are those before the joints' reaction; nu takes from them what the
/// joints do not allow. A detail of ControlledScene, over any scalar. Nothing throws.

#include <lagroid/systems/multibody/control/nodes/node_forces.hpp>
#include <lagroid/systems/multibody/control/scene_control.hpp>

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace lagroid::multibody {

/// What the motion keeps by itself, whatever the controls, along a translation a, or one with a turn b about the
/// origin.
struct HeldByMotion {
  enum class Kind {
    momentum,           ///< <a + b x, mu>
    momentum_and_drag,  ///< <a, mu + c x>, c the drag
    centre              ///< <a, m x>: where the centre of mass is
  };
  Vec translation = Vec::Zero();
  Vec turn = Vec::Zero();
  Kind kind = Kind::momentum;
  double value = 0;
};

class EndConditions {
 public:
  EndConditions() = default;
  /// Of so many rows of joints; `weights` are one over inertia and moments, and `drag` is that on them, in the order of
  /// the factors, of which some are planar.
  EndConditions(SceneEnd end, int joints, std::vector<double> weights, std::vector<Mat> drag, std::vector<char> planar);
  /// From now on values have these behind the others, less their own.
  void hold(std::vector<HeldByMotion> held) { held_ = std::move(held); }

  int size() const { return before_held() + int(held_.size()); }
  int before_held() const { return before_velocities() + int(end_.velocities.size() + end_.turnings.size()); }
  /// How many are on places and attitudes alone.
  int before_velocities() const { return joints_ + int(end_.places.size() + 3 * end_.turns.size()); }
  int joints() const { return joints_; }

  /// All of them, at a node that was evaluated.
  template <class S> void values(const NodeForces<S>& node, const std::vector<S>& momenta, std::vector<S>& out);
  template <class S> S value(const HeldByMotion& held, const NodeForces<S>& node, const std::vector<S>& momenta) const;
  /// W (mu - D^T nu).
  template <class S> void velocities(const NodeForces<S>& node, const std::vector<S>& momenta, std::vector<S>& out);

 private:
  SceneEnd end_;
  int joints_ = 0;
  std::vector<double> weights_;
  std::vector<Mat> drag_;
  std::vector<char> planar_;
  std::vector<HeldByMotion> held_;
  Eigen::MatrixXd matrix_, inverse_;  // D W D^T
};

}  // namespace lagroid::multibody
