#pragma once
/// A pendulum that a torque u swings up: q'' = -(g / l) sin q + u / (m l^2), q from the downward vertical.
///
///     ControlTask<SwingUp> task{{}, {{0, 0}, {3.141592653589793, 0}}, 10};
///     task.lower(0) = -0.5, task.upper(0) = 0.5;
///     const auto found = search_control(task, 100);  // control_search.hpp
///
/// Requires positive mass, length and gravity. State (angle, rate); the angle is one of R, not modulo 2 pi.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

namespace lagroid {

struct SwingUp : ControlledFlow<SwingUp, Pair<2>, 1> {
  double mass = 1;     ///< kg
  double length = 1;   ///< m
  double gravity = 1;  ///< m/s^2
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("mass", &SwingUp::mass, "kg", "of the bob", positive),
                      parameter("length", &SwingUp::length, "m", "of the rod", positive),
                      parameter("gravity", &SwingUp::gravity, "m/s^2", "acceleration", positive),
                      choice("cost", &SwingUp::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 2> states{"angle", "rate"};
  static constexpr std::array<std::string_view, 2> state_units{"rad", "rad/s"};
  static constexpr std::array<std::string_view, 1> control_names{"torque"};
  static constexpr std::array<std::string_view, 1> control_units{"N m"};

  template <class S> Vector<S, 2> flow(const Vector<S, 2>& q, const Vector<S, 1>& u) const {
    using std::sin;
    return {q(1), u(0) * (1 / (mass * length * length)) - sin(q(0)) * (gravity / length)};
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 1>& u) const {
    return running_cost_of(cost_of, u);
  }
};

}  // namespace lagroid
