#pragma once
/// A car that goes forward and backward, |s| <= 1, and turns at a rate |u| <= kappa: x' = s cos a, y' = s sin a, a' =
/// u, on the group SE(2), where its velocity is (u, s, 0). In the least time it goes the shortest way between poses, of
/// at most five pieces L, R, S (Reeds and Shepp 1990): that it could go more slowly, or turn where it stands, saves
/// nothing (Sussmann and Tang 1991).
///
/// Where it saves nothing it costs nothing either: ways on which it turns at the full rate all the time take as long at
/// any speed. A running cost of 1 + e (1 - s^2) with a small e chooses the speeds -1 and 1 among these, and is time at
/// them.
///
///     ControlTask<ReedsSheppCar> task{{}, FlowStates<SE2>::arrow({0, 0, 0}, {0, 1.5, 0}), 5, /*duration_is_free*/
///     true}; task.lower << -1, -1; task.upper << 1, 1; const auto found = search_control(task, 200); const double
///     length = found.minima.front().trajectory.duration();
///
/// State (x, y, angle), in the plane; the angle counts modulo 2 pi, and starts that wind find each number of turns.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct ReedsSheppCar : ControlledFlow<ReedsSheppCar, SE2, 2> {
  double creep = 1e-3;  ///< e
  static auto parameters() {
    return std::tuple(
        parameter("creep", &ReedsSheppCar::creep, "", "e of the running cost 1 + e (1 - speed^2)", nonnegative));
  }
  static constexpr std::array<std::string_view, 3> states{"x", "y", "angle"};
  static constexpr std::array<std::string_view, 3> state_units{"m", "m", "rad"};
  static constexpr std::array<std::string_view, 2> control_names{"speed", "turn_rate"};
  static constexpr std::array<std::string_view, 2> control_units{"m/s", "rad/s"};
  static constexpr std::string_view cost_unit{"s"};

  template <class Q, class S> Vector<S, 3> flow(const Q&, const Vector<S, 2>& u) const { return {u(1), u(0), S(0.0)}; }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return S(1.0) + creep * (S(1.0) - u(0) * u(0));
  }
};

}  // namespace lagroid
