#include <lagroid/systems/multibody/control/nodes/node_limits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lagroid::multibody {

NodeLimits::NodeLimits(const SceneControl& task, const NodeForces<double>& order)
    : keep_outs_(task.keep_outs), cones_(task.cones) {
  for (const SpeedLimit& each : task.speed_limits) {
    const int factor = each.linear >= 0 ? order.place_of(each.linear) : order.linear() + order.place_of(each.attitude);
    std::vector<int> components;
    for (const int axis : each.axes) components.push_back(3 * factor + axis);
    speeds_.emplace_back(std::move(components), each.most);
  }
}

void NodeLimits::require(const SceneControl& task) {
  const auto has_length_one = [](const Vec& v) { return std::abs(v.norm() - 1) < 1e-9; };
  for (const DirectionCone& each : task.cones) {
    if (each.attitude.index < 0) throw std::invalid_argument("a cone: name the attitude of a body, not the ground's");
    if (!has_length_one(each.direction) || !has_length_one(each.axis))
      throw std::invalid_argument("a cone: give its direction and its axis the length one");
    if (!(each.angle > 0 && each.angle < std::numbers::pi))
      throw std::invalid_argument(fmt::format("a cone: its angle {} is not between zero and pi", each.angle));
  }
  for (const SpeedLimit& each : task.speed_limits) {
    if (each.linear < 0 && each.attitude.index < 0)
      throw std::invalid_argument("a speed limit: name a centre or an attitude of a body");
    if (!(each.most > 0))
      throw std::invalid_argument(fmt::format("a speed limit: its largest speed {} is not positive", each.most));
    if (each.axes.empty() || std::any_of(each.axes.begin(), each.axes.end(), [](int i) { return i < 0 || i > 2; }))
      throw std::invalid_argument("a speed limit: name axes of 0, 1 and 2");
  }
}

std::string NodeLimits::name(int i) const {
  const int keep_outs = int(keep_outs_.size());
  if (i < keep_outs) return fmt::format("keep-out {}", i + 1);
  if (i < on_places()) return fmt::format("cone {}", i - keep_outs + 1);
  return fmt::format("speed limit {}", i - on_places() + 1);
}

}  // namespace lagroid::multibody
