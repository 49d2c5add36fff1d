#pragma once
/// A ball rolled without slipping on a plate that turns, (x, y)' = u, at the least |u|^2 and with |u| bounded, to a
/// place and an attitude: the paper's optimal control problem, with a bound. In the words of PlateBall, on
/// R^2 x R^2 x SO(3) => R^2,
///
///     w = ((Omega x - v) / r, (u + Omega y) / r, spin).
///
///     RolledBall ball;
///     ball.largest_speed = 2;
///     const auto roll = FlowStates<RolledBall::GroupoidType>::arrow(start, end);
///     const auto found = search_control(ControlTask<RolledBall>{ball, roll, 5}, 100);  // control_search.hpp
///
/// Requires a positive radius; a largest speed of zero is none. State (x, y, r1, r2, r3): place of the contact,
/// rotation vector of the attitude. [G] 6.2

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct RolledBall : ControlledFlow<RolledBall, Product<Pair<2>, SO3>, /*controls*/ 2, /*inequalities*/ 1> {
  double radius = 1;         ///< r, m
  double plate_rate = 0;     ///< Omega, rad/s
  double spin = 0;           ///< rad/s
  double largest_speed = 0;  ///< m/s; 0: any
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("radius", &RolledBall::radius, "m", "of the ball", positive),
                      parameter("plate_rate", &RolledBall::plate_rate, "rad/s", "angular velocity of the plate"),
                      parameter("spin", &RolledBall::spin, "rad/s", "prescribed rate about the vertical"),
                      parameter("largest_speed", &RolledBall::largest_speed, "m/s", "|u| at most; 0: any", nonnegative),
                      choice("cost", &RolledBall::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 5> states{"x", "y", "r1", "r2", "r3"};
  static constexpr std::array<std::string_view, 5> state_units{"m", "m", "rad", "rad", "rad"};
  static constexpr std::array<std::string_view, 2> control_names{"ux", "uy"};
  static constexpr std::array<std::string_view, 2> control_units{"m/s", "m/s"};

  template <class Q, class S> Vector<S, 5> flow(const Q& q, const Vector<S, 2>& u) const {
    const auto& at = std::get<0>(q);
    Vector<S, 5> out;
    out(0) = u(0);
    out(1) = u(1);
    out(2) = (at(0) * plate_rate - u(1)) * (1 / radius);
    out(3) = (u(0) + at(1) * plate_rate) * (1 / radius);
    out(4) = S(spin);
    return out;
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  bool has_inequalities() const { return largest_speed > 0; }
  template <class A, class S> Vector<S, 1> inequality(const A&, const Vector<S, 2>& u, const S&) const {
    if (largest_speed == 0) return Vector<S, 1>(S(-1.0));
    return Vector<S, 1>((u(0) * u(0) + u(1) * u(1)) * (1 / (largest_speed * largest_speed)) - 1.0);
  }
};

}  // namespace lagroid
