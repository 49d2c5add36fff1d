#pragma once
/// Systems of the library moved by forces in the first components of their momenta, at the cost of |u|^2: a pendulum, a
/// rigid body, each by its own discrete steps.
///
///     ControlTask<PushedPendulum> task{{}, FlowStates<PushedPendulum::GroupoidType>::arrow({0, 0}, {3.14, 0}), 10};
///     const auto found = search_control(task, 100);  // control_search.hpp
///
/// Requires what the system does. States are configuration and momentum. `Pushed<Sys, C>` is the same for any system of
/// ActuatedSystem.

#include <lagroid/solvers/control/actuated_system.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <array>
#include <string_view>

namespace lagroid {

template <class Sys, int C> struct Pushed : ActuatedSystem<Pushed<Sys, C>, Sys, C> {
  template <class Q, class S> Vector<S, Sys::dimension> force(const Q&, const Vector<S, C>& u) const {
    Vector<S, Sys::dimension> out;
    for (int i = 0; i < Sys::dimension; ++i) out(i) = i < C ? u(i) : S(0.0);
    return out;
  }
  template <class State, class S> S running_cost(const State&, const Vector<S, C>& u) const {
    S sum = u(0) * u(0);
    for (int i = 1; i < C; ++i) sum += u(i) * u(i);
    return sum;
  }
};

struct PushedPendulum : Pushed<Pendulum, 1> {
  static constexpr std::array<std::string_view, 2> states{"angle", "momentum"};
  static constexpr std::array<std::string_view, 2> state_units{"rad", "kg m^2/s"};
  static constexpr std::array<std::string_view, 1> control_names{"torque"};
  static constexpr std::array<std::string_view, 1> control_units{"N m"};
};

struct PushedBody : Pushed<RigidBody, 3> {
  static constexpr std::array<std::string_view, 6> states{"r1", "r2", "r3", "M1", "M2", "M3"};
  static constexpr std::array<std::string_view, 6> state_units{"rad", "rad", "rad", "kg m^2/s", "kg m^2/s", "kg m^2/s"};
  static constexpr std::array<std::string_view, 3> control_names{"torque1", "torque2", "torque3"};
  static constexpr std::array<std::string_view, 3> control_units{"N m", "N m", "N m"};
};

}  // namespace lagroid
