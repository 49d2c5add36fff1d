#include <lagroid/groupoids/groups/so3.hpp>
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
    int first = order.size() + 3 * int(points_.size());
    if (each.linear >= 0)
      first = 3 * order.place_of(each.linear);
    else if (each.attitude.index >= 0)
      first = 3 * (order.linear() + order.place_of(each.attitude));
    else
      points_.push_back(each.site);
    std::vector<int> components;
    for (const int axis : each.axes) components.push_back(first + axis);
    speeds_.emplace_back(std::move(components), each.most);
  }
  const auto add_names = [&](const auto& limits, const char* kind) {
    for (std::size_t i = 0; i < limits.size(); ++i)
      names_.push_back(limits[i].name.empty() ? fmt::format("{} {}", kind, i + 1) : limits[i].name);
  };
  add_names(task.keep_outs, "keep-out");
  add_names(task.cones, "cone");
  add_names(task.speed_limits, "speed limit");
}

void NodeLimits::require(const SceneControl& task) {
  const auto has_length_one = [](const Vec& v) { return std::abs(v.norm() - 1) < 1e-9; };
  for (const KeepOut& each : task.keep_outs) {
    const bool is_plane = each.kind == KeepOut::Kind::plane;
    if (is_plane && !has_length_one(each.normal))
      throw std::invalid_argument("a plane to keep off: give its normal the length one");
    if (!is_plane && !(each.radius > 0))
      throw std::invalid_argument(fmt::format("what is to be kept out of has a radius: {} is none", each.radius));
  }
  for (const DirectionCone& each : task.cones) {
    if (each.attitude.index < 0) throw std::invalid_argument("a cone: name the attitude of a body, not the ground's");
    if (!has_length_one(each.direction) || !has_length_one(each.axis))
      throw std::invalid_argument("a cone: give its direction and its axis the length one");
    if (!(each.angle > 0 && each.angle < std::numbers::pi))
      throw std::invalid_argument(fmt::format("a cone: its angle {} is not between zero and pi", each.angle));
    for (const SceneEnd::Turn& turn : task.end.turns)
      if (turn.attitude.index == each.attitude.index && each.value(SO3::from_quaternion(turn.value)) > limit_rounding)
        throw std::invalid_argument("the end that is given is where a cone is not kept to: change one of them");
  }
  for (const SpeedLimit& each : task.speed_limits) {
    if ((each.linear >= 0) + (each.attitude.index >= 0) + (each.site.index >= 0) != 1)
      throw std::invalid_argument("a speed limit: name a centre or an attitude of a body, or a point, and one of them");
    if (!(each.most > 0))
      throw std::invalid_argument(fmt::format("a speed limit: its largest speed {} is not positive", each.most));
    if (each.axes.empty() || std::any_of(each.axes.begin(), each.axes.end(), [](int i) { return i < 0 || i > 2; }))
      throw std::invalid_argument("a speed limit: name axes of 0, 1 and 2");
    double square = 0;
    const auto add = [&](bool is_of_it, int axis, double value) {
      if (is_of_it && std::find(each.axes.begin(), each.axes.end(), axis) != each.axes.end()) square += value * value;
    };
    for (const SceneEnd::Velocity& v : task.end.velocities) add(v.linear == each.linear, v.axis, v.value);
    for (const SceneEnd::Turning& w : task.end.turnings)
      add(each.linear < 0 && w.attitude.index == each.attitude.index, w.axis, w.value);
    if (std::sqrt(square) > each.most * (1 + limit_rounding))
      throw std::invalid_argument(
          fmt::format("the end that is given has the speed {:.4g}, above its limit {:.4g}: change one of them",
                      std::sqrt(square), each.most));
  }
}

}  // namespace lagroid::multibody
