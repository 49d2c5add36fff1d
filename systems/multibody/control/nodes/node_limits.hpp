#pragma once
/// What the nodes of a controlled scene keep to: gamma_i <= 0, of each KeepOut, of each DirectionCone, and of each
/// SpeedLimit, in this order; the last are on velocities.
///
/// A detail of ControlledScene, over any scalar. `require` throws std::invalid_argument, one line, for limits that are
/// none.

#include <lagroid/systems/multibody/control/nodes/node_forces.hpp>
#include <lagroid/systems/multibody/control/scene_control.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid::multibody {

class NodeLimits {
 public:
  NodeLimits() = default;
  /// Of a task, in the order of the factors at its nodes.
  NodeLimits(const SceneControl& task, const NodeForces<double>& order);
  static void require(const SceneControl& task);

  int size() const { return on_places() + on_velocities(); }
  int on_places() const { return int(keep_outs_.size() + cones_.size()); }
  int on_velocities() const { return int(speeds_.size()); }
  /// How many points have a limit of their speed.
  int points() const { return int(points_.size()); }

  /// gamma_i, i < on_places(), at a node that was evaluated.
  template <class S> S value(int i, const NodeForces<S>& node) const {
    const auto k = std::size_t(i);
    if (k < keep_outs_.size()) return keep_outs_[k].value(node(keep_outs_[k].site));
    const DirectionCone& cone = cones_[k - keep_outs_.size()];
    return cone.value(node(cone.attitude));
  }
  /// Velocities of a node, W (mu - D^T nu), and behind them those of the points that limits are on.
  template <class S> void add_points(const NodeForces<S>& node, std::vector<S>& velocities) const {
    for (const Site site : points_) {
      const Vector<S, 3> v = node.velocity(site, velocities);
      velocities.insert(velocities.end(), v.data(), v.data() + 3);
    }
  }
  /// gamma_{on_places() + k} of these velocities.
  template <class S> S value_of_speed(int k, const std::vector<S>& velocities) const {
    S square = S(0);
    for (const int i : components(k)) square += velocities[std::size_t(i)] * velocities[std::size_t(i)];
    return square * weight(k) - 1.0;
  }
  /// Which velocities these are, and one over the square of the largest speed.
  const std::vector<int>& components(int k) const { return speeds_[std::size_t(k)].first; }
  double weight(int k) const { return 1 / (speeds_[std::size_t(k)].second * speeds_[std::size_t(k)].second); }

  /// As its task calls it, or "cone 2".
  const std::string& name(int i) const { return names_[std::size_t(i)]; }

 private:
  std::vector<KeepOut> keep_outs_;
  std::vector<DirectionCone> cones_;
  std::vector<std::pair<std::vector<int>, double>> speeds_;  // components, and the largest speed
  std::vector<Site> points_;
  std::vector<std::string> names_;
};

}  // namespace lagroid::multibody
