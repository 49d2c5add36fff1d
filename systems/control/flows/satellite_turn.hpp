#pragma once
/// A satellite turned by torques u about its principal axes, J w' = J w x w + u, that keeps its boresight e_3 off a
/// direction fixed in space, as a star tracker off the sun: s.R e_3 <= cos(cone). The action groupoid of SO(3) on S^2
/// carries s as the body sees it, R^T s, so that the constraint is one on objects.
///
///     SatelliteTurn satellite;
///     const auto turn = FlowStates<SatelliteTurn::GroupoidType>::arrow(start, end, satellite.avoided);
///     const auto found = solve_control(ControlTask<SatelliteTurn>{satellite, turn, 5}, 100);
///
/// Requires positive inertias, a unit vector s, and ends outside of the cone; a cone of angle zero is none.
/// State (r1, r2, r3, w1, w2, w3): rotation vector of the attitude, angular velocity in the body.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

namespace lagroid {

struct SatelliteTurn : ControlledFlow<SatelliteTurn, Product<Action<SO3, RotatedDirections>, Pair<3>>, 3, 1> {
  Vector<double, 3> inertia{1, 2, 3};  ///< kg m^2
  Vector<double, 3> avoided{1, 0, 0};  ///< s, in space
  double cone = 0;                     ///< rad
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    constexpr NumberRule an_angle{"from 0 to pi", [](double x) { return x >= 0 && x <= std::numbers::pi; }};
    return std::tuple(parameter("inertia", &SatelliteTurn::inertia, "kg m^2", "principal moments", positive),
                      direction("avoided", &SatelliteTurn::avoided, "the direction that the third axis keeps off"),
                      parameter("cone", &SatelliteTurn::cone, "rad", "how far, at least; 0: anywhere", an_angle),
                      choice("cost", &SatelliteTurn::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array flow_reads{false, true};  // not the direction
  static constexpr std::array<std::string_view, 6> states{"r1", "r2", "r3", "w1", "w2", "w3"};
  static constexpr std::array<std::string_view, 6> state_units{"rad", "rad", "rad", "rad/s", "rad/s", "rad/s"};
  static constexpr std::array<std::string_view, 3> control_names{"torque1", "torque2", "torque3"};
  static constexpr std::array<std::string_view, 3> control_units{"N m", "N m", "N m"};

  template <class Q, class S> Vector<S, 6> flow(const Q& q, const Vector<S, 3>& u) const {
    const Vector<S, 3>& w = std::get<1>(q);
    Vector<S, 6> out;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out(i) = w(i);
      out(3 + i) = (w(j) * w(k) * (inertia(j) - inertia(k)) + u(i)) * (1 / inertia(i));
    }
    return out;
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 3>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  bool has_inequalities() const { return cone > 0; }
  template <class A, class S> Vector<S, 1> inequality(const A& g, const Vector<S, 3>&, const S&) const {
    using std::cos;
    if (!(cone > 0)) return Vector<S, 1>(S(-1.0));
    const auto& [turn, rates] = g;
    const Vector<S, 3> seen = RotatedDirections::act(turn.point, turn.element);
    return Vector<S, 1>(seen(2) - cos(cone));
  }
};

}  // namespace lagroid
