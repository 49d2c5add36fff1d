#pragma once
/// What the equations of a stage and their costates are called. Each belongs to a coordinate of the algebroid, and its
/// costate is called as the momentum of a run is: px of a coordinate x, M, p1, p2 of SE(2), M1, M2, M3 of SO(3).
/// Systems that are moved by their own discrete steps have an equation of each momentum M at either end of an arrow,
/// with the costates pM_source and pM_target.
///
///     const std::vector<EquationName> names = equation_names<DubinsCar>();
///
/// The unit of a costate is that of the cost per unit of the coordinate. Requires `states` and `state_units` of the
/// system, number by number as FlowStates has them. Nothing throws.

#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/systems/control/flows/control_cost.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

struct EquationName {
  std::string of;       ///< what it is of, in sentences
  std::string costate;  ///< the column
  std::string unit;     ///< of the coordinate
};

/// UNIT of the cost per unit of something else, as in "s/(m/s)".
std::string per(const std::string& cost, const std::string& unit);
/// Of the integral of |u|^2 over time, where all of u has one unit; else "cost".
std::string effort_unit(std::span<const std::string_view> of_controls);
/// An equation of a momentum at both ends of an arrow, all sources first.
void add_momentum_equations(const std::vector<std::string>& momenta, const std::vector<std::string>& units,
                            std::vector<EquationName>& out);

/// The coordinates of the algebroid of G, by the numbers of a state.
template <class G> struct CoordinateNames;

template <int N> struct CoordinateNames<Pair<N>> {
  static constexpr std::size_t numbers = N;
  static void add(const std::string_view* states, const std::string_view* units, std::vector<EquationName>& out) {
    for (int i = 0; i < N; ++i)
      out.push_back({std::string(states[i]), "p" + std::string(states[i]), std::string(units[i])});
  }
};
template <> struct CoordinateNames<SE2> {
  static constexpr std::size_t numbers = 3;
  static void add(const std::string_view*, const std::string_view* units, std::vector<EquationName>& out) {
    out.push_back({"turning", "M", std::string(units[2])});
    out.push_back({"motion ahead", "p1", std::string(units[0])});
    out.push_back({"motion aside", "p2", std::string(units[1])});
  }
};
template <> struct CoordinateNames<SO3> {
  static constexpr std::size_t numbers = 3;
  static void add(const std::string_view*, const std::string_view*, std::vector<EquationName>& out) {
    for (const char* axis : {"1", "2", "3"})
      out.push_back({std::string("turning about axis ") + axis, std::string("M") + axis, "rad"});
  }
};
template <> struct CoordinateNames<Action<SO3, RotatedDirections>> : CoordinateNames<SO3> {};
template <class... Gs> struct CoordinateNames<Product<Gs...>> {
  static constexpr std::size_t numbers = (CoordinateNames<Gs>::numbers + ...);
  static void add(const std::string_view* states, const std::string_view* units, std::vector<EquationName>& out) {
    std::size_t at = 0;
    ((CoordinateNames<Gs>::add(states + at, units + at, out), at += CoordinateNames<Gs>::numbers), ...);
  }
};

/// Of the rows of phi, in their order.
template <class Sys> std::vector<EquationName> equation_names() {
  std::vector<EquationName> out;
  if constexpr (requires { typename Sys::Motion; }) {
    static_assert(Sys::equalities == 2 * Sys::rank, "reactions are not named");
    std::vector<std::string> momenta(Sys::states.end() - Sys::rank, Sys::states.end());
    std::vector<std::string> units(Sys::state_units.end() - Sys::rank, Sys::state_units.end());
    add_momentum_equations(momenta, units, out);
  } else {
    CoordinateNames<typename Sys::GroupoidType>::add(Sys::states.data(), Sys::state_units.data(), out);
  }
  return out;
}

/// What the system's cost is counted in.
template <class Sys> std::string cost_unit_of(const Sys& system) {
  if (system.weights) return "cost";
  if constexpr (requires { Sys::cost_unit; }) {
    return std::string(Sys::cost_unit);
  } else {
    if constexpr (requires { system.cost_of; })
      if (system.cost_of == ControlCost::time) return "s";
    return effort_unit(Sys::control_units);
  }
}

}  // namespace lagroid::app
