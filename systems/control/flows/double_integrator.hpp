#pragma once
/// A mass on a line under a force u, x'' = u, with a bound on its speed: the first example of optimal control.
///
///     ControlTask<DoubleIntegrator> task{{}, {{0, 0}, {1, 0}}, 1};
///     task.system.largest_speed = 1.25;
///     const auto found = solve_control(task, 100);  // cost near 125 / 9
///
/// State (x, v). A largest speed of zero is none.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct DoubleIntegrator : ControlledFlow<DoubleIntegrator, Pair<2>, 1, 2> {
  double largest_speed = 0;  ///< of |v|; 0: any
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(
        parameter("largest_speed", &DoubleIntegrator::largest_speed, "m/s", "|v| at most; 0: any", nonnegative),
        choice("cost", &DoubleIntegrator::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 2> states{"x", "v"};
  static constexpr std::array<std::string_view, 2> state_units{"m", "m/s"};
  static constexpr std::array<std::string_view, 1> control_names{"u"};
  static constexpr std::array<std::string_view, 1> control_units{"m/s^2"};

  template <class S> Vector<S, 2> flow(const Vector<S, 2>& q, const Vector<S, 1>& u) const { return {q(1), u(0)}; }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 1>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  bool has_inequalities() const { return largest_speed > 0; }
  template <class S> Vector<S, 2> inequality(const PairArrow<S, 2>& g, const Vector<S, 1>&, const S&) const {
    if (largest_speed == 0) return {S(-1.0), S(-1.0)};
    return {g.target(1) - largest_speed, -g.target(1) - largest_speed};
  }
};

}  // namespace lagroid
