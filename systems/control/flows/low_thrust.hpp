#pragma once
/// A spacecraft in the plane about a center of attraction, r'' = -mu r / |r|^3 + u, with a bound of the thrust.
///
///     ControlTask<LowThrust> task{{}, {{1, 0, 0, 1}, {-1.5, 0, 0, -0.816}}, 6};
///     task.system.largest_thrust = 0.1;
///     const auto found = search_control(task, 100);  // control_search.hpp
///
/// Requires a positive mu, and trajectories that stay off the center. State (x, y, vx, vy). A largest thrust of zero is
/// none.

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

struct LowThrust : ControlledFlow<LowThrust, Pair<4>, 2, 1> {
  double strength = 1;        ///< mu
  double largest_thrust = 0;  ///< 0: any
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("strength", &LowThrust::strength, "1", "mu", positive),
                      parameter("largest_thrust", &LowThrust::largest_thrust, "1", "|u| at most; 0: any", nonnegative),
                      choice("cost", &LowThrust::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 4> states{"x", "y", "vx", "vy"};
  static constexpr std::array<std::string_view, 4> state_units{"1", "1", "1", "1"};
  static constexpr std::array<std::string_view, 2> control_names{"ax", "ay"};
  static constexpr std::array<std::string_view, 2> control_units{"1", "1"};

  template <class S> Vector<S, 4> flow(const Vector<S, 4>& q, const Vector<S, 2>& u) const {
    using std::sqrt;
    const S square = q(0) * q(0) + q(1) * q(1);
    const S pull = strength / (square * sqrt(square));
    return {q(2), q(3), u(0) - pull * q(0), u(1) - pull * q(1)};
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  bool has_inequalities() const { return largest_thrust > 0; }
  template <class S> Vector<S, 1> inequality(const PairArrow<S, 4>&, const Vector<S, 2>& u, const S&) const {
    if (largest_thrust == 0) return Vector<S, 1>(S(-1.0));
    return Vector<S, 1>((u(0) * u(0) + u(1) * u(1)) * (1 / (largest_thrust * largest_thrust)) - 1.0);
  }
};

}  // namespace lagroid
