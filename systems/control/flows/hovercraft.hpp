#pragma once
/// A hovercraft on SE(2): a force u1 along its axis through the center of mass, a torque u2,
///
///     m (vx' - w vy) = u1,    m (vy' + w vx) = 0,    I w' = u2,    velocities in the body.
///
///     ControlTask<Hovercraft> task{{}, FlowStates<Hovercraft::GroupoidType>::arrow(start, end), 4};
///     const auto found = search_control(task, 100);  // control_search.hpp
///
/// Requires positive mass and inertia. State (x, y, angle, w, vx, vy).

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct Hovercraft : ControlledFlow<Hovercraft, Product<SE2, Pair<3>>, 2> {
  double mass = 1;       ///< kg
  double inertia = 0.5;  ///< kg m^2
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("mass", &Hovercraft::mass, "kg", "m", positive),
                      parameter("inertia", &Hovercraft::inertia, "kg m^2", "I", positive),
                      choice("cost", &Hovercraft::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 6> states{"x", "y", "angle", "w", "vx", "vy"};
  static constexpr std::array<std::string_view, 6> state_units{"m", "m", "rad", "rad/s", "m/s", "m/s"};
  static constexpr std::array<std::string_view, 2> control_names{"force", "torque"};
  static constexpr std::array<std::string_view, 2> control_units{"N", "N m"};

  template <class Q, class S> Vector<S, 6> flow(const Q& q, const Vector<S, 2>& u) const {
    const Vector<S, 3>& v = std::get<1>(q);  // w, vx, vy
    Vector<S, 6> out;
    out << v(0), v(1), v(2), u(1) * (1 / inertia), u(0) * (1 / mass) + v(0) * v(2), -v(0) * v(1);
    return out;
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
};

}  // namespace lagroid
