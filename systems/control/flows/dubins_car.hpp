#pragma once
/// A car at unit speed that steers by its curvature u: x' = cos a, y' = sin a, a' = u, on the group SE(2), where its
/// velocity is (u, 1, 0) for good. Shortest ways between poses are arcs and straight lines (Dubins 1957).
///
///     ControlTask<DubinsCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {4, 2, 1}), 5, /*duration_is_free*/ true};
///     task.lower(0) = -1, task.upper(0) = 1;
///     const auto found = solve_control(task, 100);
///
/// State (x, y, angle), in the plane; the angle counts modulo 2 pi, and starts that wind find each number of turns.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct DubinsCar : ControlledFlow<DubinsCar, SE2, 1> {
  ControlCost cost_of = ControlCost::time;
  static auto parameters() {
    return std::tuple(choice("cost", &DubinsCar::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 3> states{"x", "y", "angle"};
  static constexpr std::array<std::string_view, 3> state_units{"m", "m", "rad"};
  static constexpr std::array<std::string_view, 1> control_names{"curvature"};
  static constexpr std::array<std::string_view, 1> control_units{"1/m"};

  template <class Q, class S> Vector<S, 3> flow(const Q&, const Vector<S, 1>& u) const {
    return {u(0), S(1.0), S(0.0)};
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 1>& u) const {
    return running_cost_of(cost_of, u);
  }
};

}  // namespace lagroid
