#pragma once
/// What a control problem says of one state by itself: which inequality does not hold there, and whether the motion can
/// wait there at no cost; and whether a control is as large as one likes.
///
///     if (const auto i = broken_at(system, node)) refuse(limits[*i]);
///     if (phase.duration_is_free && can_wait(phase, node)) refuse("no duration is the best");
///
/// Nothing throws.

#include <lagroid/solvers/control/control_system.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>

namespace lagroid::app {

template <class Sys> using NodeOf = ObjectOf<typename Sys::GroupoidType>;

/// From one state to another.
template <class Sys, class State> auto arrow_between(const Sys& system, const State& start, const State& end) {
  using States = FlowStates<typename Sys::GroupoidType>;
  if constexpr (requires { system.avoided; }) {
    return States::arrow(start, end, system.avoided);
  } else {
    return States::arrow(start, end);
  }
}

/// The first inequality that does not hold at a node, whatever leads there. One that is the same number along arrows,
/// controls and steps drawn at random is of the node alone; of the others nothing is said.
template <class Sys> std::optional<std::size_t> broken_at(const Sys& system, const NodeOf<Sys>& node) {
  if constexpr (Sys::inequalities > 0) {
    constexpr int draws = 3;
    constexpr double rounding = 1e-9;
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal(0, 0.3);
    Vector<double, Sys::inequalities> first;
    std::array<bool, std::size_t(Sys::inequalities)> is_of_node;
    is_of_node.fill(true);
    for (int k = 0; k < draws; ++k) {
      AlgebroidVector<typename Sys::GroupoidType> back;
      Vector<double, Sys::controls> u;
      for (double& x : back) x = normal(generator);
      for (double& x : u) x = normal(generator);
      const auto arrow = system.groupoid.inverse(system.groupoid.tau(node, back));
      const Vector<double, Sys::inequalities> gamma = system.inequality(arrow, u, std::exp(normal(generator)));
      if (k == 0) first = gamma;
      for (int i = 0; i < Sys::inequalities; ++i)
        if (!(std::abs(gamma(i) - first(i)) <= rounding * (1 + std::abs(first(i))))) is_of_node[std::size_t(i)] = false;
    }
    for (int i = 0; i < Sys::inequalities; ++i)
      if (is_of_node[std::size_t(i)] && first(i) > rounding) return std::size_t(i);
  }
  return std::nullopt;
}

/// Whether to rest there, with controls as near to zero as their bounds allow, is a motion of no cost: then any motion
/// that comes by can take as much longer, and costs no more.
template <class Sys> bool can_wait(const ControlPhase<Sys>& phase, const NodeOf<Sys>& node) {
  constexpr double rounding = 1e-12;
  const Sys& system = phase.system;
  const auto rest = system.groupoid.unit(node);
  const double h = phase.duration / double(phase.stages);
  Vector<double, Sys::controls> u;
  for (int i = 0; i < Sys::controls; ++i) u(i) = std::clamp(0.0, phase.lower(i), phase.upper(i));
  if (!(system.cost(rest, u, h) <= 0)) return false;
  for (const double left : system.constraint(rest, u, h))
    if (!(std::abs(left) <= rounding)) return false;
  if constexpr (Sys::inequalities > 0)
    if (phase.inequalities_hold)
      for (const double gamma : system.inequality(rest, u, h))
        if (!(gamma <= 0)) return false;
  return true;
}

/// Whether a control has no bound on one side, and costs nothing along an arrow: with it motions may be as fast as they
/// like.
template <class Sys>
bool has_unbounded_control(const ControlPhase<Sys>& phase, const ArrowOf<typename Sys::GroupoidType>& along) {
  using Controls = Vector<double, Sys::controls>;
  const double h = phase.duration / double(phase.stages);
  const double of_none = phase.system.cost(along, Controls(Controls::Zero()), h);
  const auto is_free_of_cost = [&](int i, double u) {
    return phase.system.cost(along, Controls(u * Controls::Unit(i)), h) == of_none;
  };
  for (int i = 0; i < Sys::controls; ++i)
    if ((!std::isfinite(phase.upper(i)) && is_free_of_cost(i, 1)) ||
        (!std::isfinite(phase.lower(i)) && is_free_of_cost(i, -1)))
      return true;
  return false;
}

}  // namespace lagroid::app
