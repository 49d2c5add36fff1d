#pragma once
/// A car with front wheels that turn by an angle p: a' = v tan(p) / l, with acceleration u1 and steering rate u2,
/// |p| bounded.
///
///     ControlTask<SteeredCar> task{{}, FlowStates<SteeredCar::GroupoidType>::arrow(start, end), 5};
///     task.system.largest_steering = 0.4;
///     const auto found = search_control(task, 100);  // control_search.hpp
///
/// Requires a positive wheelbase and a bound below pi / 2. State (x, y, angle, v, steering), (x, y) the rear axle.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

namespace lagroid {

inline constexpr NumberRule below_a_right_angle{"positive and below pi / 2",
                                                [](double x) { return x > 0 && x < std::numbers::pi / 2; }};

struct SteeredCar : ControlledFlow<SteeredCar, Product<SE2, Pair<2>>, 2, 2> {
  double wheelbase = 1;           ///< l, m
  double largest_steering = 1.2;  ///< rad
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("wheelbase", &SteeredCar::wheelbase, "m", "l", positive),
                      parameter("largest_steering", &SteeredCar::largest_steering, "rad", "|p| at most, below pi / 2",
                                below_a_right_angle),
                      choice("cost", &SteeredCar::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 5> states{"x", "y", "angle", "v", "steering"};
  static constexpr std::array<std::string_view, 5> state_units{"m", "m", "rad", "m/s", "rad"};
  static constexpr std::array<std::string_view, 2> control_names{"acceleration", "steering_rate"};
  static constexpr std::array<std::string_view, 2> control_units{"m/s^2", "rad/s"};

  template <class Q, class S> Vector<S, 5> flow(const Q& q, const Vector<S, 2>& u) const {
    using std::cos;
    using std::sin;
    const Vector<S, 2>& v = std::get<1>(q);  // v, p
    Vector<S, 5> out;
    out << v(0) * sin(v(1)) / cos(v(1)) * (1 / wheelbase), v(0), S(0.0), u(0), u(1);
    return out;
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  template <class A, class S> Vector<S, 2> inequality(const A& g, const Vector<S, 2>&, const S&) const {
    const auto& to = std::get<1>(g).target;
    return {to(1) - largest_steering, -to(1) - largest_steering};
  }
};

}  // namespace lagroid
