#pragma once
/// A mass in the plane under a force, (x, y)'' = u, |u| bounded, that keeps out of a disk.
///
///     ControlTask<PlanarMass> task{{}, {{-2, -0.3, 0, 0}, {2, 0.2, 0, 0}}, 4};
///     task.system.disk_radius = 1;
///     const auto found = solve_control(task, 200);
///
/// State (x, y, vx, vy). A largest force of zero is none, and so is a disk of radius zero.

#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <string_view>
#include <tuple>

namespace lagroid {

struct PlanarMass : ControlledFlow<PlanarMass, Pair<4>, 2, 2> {
  double largest_force = 0;  ///< 0: any
  Vector<double, 2> disk_center{0, 0};
  double disk_radius = 0;
  ControlCost cost_of = ControlCost::effort;
  static auto parameters() {
    return std::tuple(parameter("largest_force", &PlanarMass::largest_force, "1", "|u| at most; 0: any", nonnegative),
                      parameter("disk_center", &PlanarMass::disk_center, "m", "of the disk to keep out of"),
                      parameter("disk_radius", &PlanarMass::disk_radius, "m", "its radius; 0: no disk", nonnegative),
                      choice("cost", &PlanarMass::cost_of, control_cost_words, "integral of |u|^2, or time"));
  }
  static constexpr std::array<std::string_view, 4> states{"x", "y", "vx", "vy"};
  static constexpr std::array<std::string_view, 4> state_units{"m", "m", "m/s", "m/s"};
  static constexpr std::array<std::string_view, 2> control_names{"ux", "uy"};
  static constexpr std::array<std::string_view, 2> control_units{"m/s^2", "m/s^2"};

  template <class S> Vector<S, 4> flow(const Vector<S, 4>& q, const Vector<S, 2>& u) const {
    return {q(2), q(3), u(0), u(1)};
  }
  template <class Q, class S> S running_cost(const Q&, const Vector<S, 2>& u) const {
    return running_cost_of(cost_of, u);
  }
  static constexpr bool inequalities_of_end = true;
  bool has_inequalities() const { return largest_force > 0 || disk_radius > 0; }
  template <class S> Vector<S, 2> inequality(const PairArrow<S, 4>& g, const Vector<S, 2>& u, const S&) const {
    S force(-1.0);
    if (largest_force > 0) force = (u(0) * u(0) + u(1) * u(1)) * (1 / (largest_force * largest_force)) - 1.0;
    if (disk_radius == 0) return {force, S(-1.0)};
    const S x = g.target(0) - disk_center(0);
    const S y = g.target(1) - disk_center(1);
    return {force, S(1.0) - (x * x + y * y) * (1 / (disk_radius * disk_radius))};
  }
};

}  // namespace lagroid
