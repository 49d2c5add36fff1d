#pragma once
/// A sleigh on a blade that allows no side slip, with its center of mass at a distance a ahead: force u1 along the
/// blade, torque u2,
///
///     v' = a w^2 + u1 / m,    (I + m a^2) w' = -m a w v + u2.
///
///     ControlTask<SteeredSleigh> task{{}, FlowStates<SteeredSleigh::GroupoidType>::arrow(start, end), 4};
///     const auto found = solve_control(task, 100);
///
/// Requires positive mass and inertia. State (x, y, angle, v, w). Its uncontrolled motion is Chaplygin's sleigh.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct SteeredSleigh : ControlledFlow<SteeredSleigh, Product<SE2, Pair<2>>, 2> {
  double mass = 1;        ///< kg
  double inertia = 0.25;  ///< kg m^2
  double ahead = 0.2;     ///< a, m
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("mass", &SteeredSleigh::mass, "kg", "m", positive),
                      parameter("inertia", &SteeredSleigh::inertia, "kg m^2", "I about the center of mass", positive),
                      parameter("ahead", &SteeredSleigh::ahead, "m", "of the blade, the center of mass"),
                      choice("cost", &SteeredSleigh::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 5> states{"x", "y", "angle", "v", "w"};
  static constexpr std::array<std::string_view, 5> state_units{"m", "m", "rad", "m/s", "rad/s"};
  static constexpr std::array<std::string_view, 2> control_names{"force", "torque"};
  static constexpr std::array<std::string_view, 2> control_units{"N", "N m"};

  template <class Q, class S> Vector<S, 5> flow(const Q& q, const Vector<S, 2>& u) const {
    const Vector<S, 2>& v = std::get<1>(q);  // v, w
    Vector<S, 5> out;
    out << v(1), v(0), S(0.0), v(1) * v(1) * ahead + u(0) * (1 / mass),
        (u(1) - v(0) * v(1) * (mass * ahead)) * (1 / (inertia + mass * ahead * ahead));
    return out;
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
};

}  // namespace lagroid
