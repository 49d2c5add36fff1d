#pragma once
/// What the scenes of point masses on R^n have in common.

#include "../scenes/boundary_value.hpp"
#include "../scenes/system_module.hpp"

#include <lagroid/systems/mechanical.hpp>

namespace lagroid::app {

/// A state as vectors of R^n.
struct VectorKeys {
  KeyOf<NumberArray> position;
  KeyOf<NumberArray> momentum;
};
template <class Sys> SystemKeys keys_of(const VectorKeys& state) {
  return {parameter_keys<Sys>(), {state.position, state.momentum}, {state.position}};
}

template <int N> State<Pair<N>> read_vector_state(const Section& initial, const VectorKeys& keys) {
  State<Pair<N>> s;
  s.object = Eigen::Map<const Vector<double, N>>(read_key(initial, keys.position).data());
  s.momentum = Eigen::Map<const Vector<double, N>>(read_key(initial, keys.momentum).data());
  return s;
}

/// Positions, momenta and two panels; the caller fills in labels.
template <class Sys, int N>
Presentation<Sys> vector_presentation(std::string name, std::vector<std::string> position, std::string position_unit,
                                      std::vector<std::string> momentum, std::string momentum_unit) {
  Presentation<Sys> p;
  p.name = std::move(name);
  p.position = std::move(position);
  p.position_unit = std::move(position_unit);
  p.momentum = std::move(momentum);
  p.momentum_unit = std::move(momentum_unit);
  p.position_of = [](const TrajectoryPoint<Sys>& point) {
    const auto& q = point.state.object;
    return std::vector<double>(q.data(), q.data() + N);
  };
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  return p;
}

/// [boundary] start and end, each a position that `check(system, section, q)` refuses or returns, and the time between
/// them.
template <class Sys, int N, class Check>
BoundaryScene<Sys> read_vector_boundary(const Section& scene, Sys system, const KeyOf<NumberArray>& position,
                                        const Check& check) {
  const TimeGrid grid = read_time(scene);
  system.h = grid.step;
  const Section boundary = scene.section("boundary", "start and end");
  const auto end = [&](std::string_view key) {
    const Section section = boundary.section(key, "position");
    return check(system, section,
                 Vector<double, N>(Eigen::Map<const Vector<double, N>>(read_key(section, position).data())));
  };
  const Vector<double, N> from = end("start");
  return {{{system, PairArrow<double, N>{from, end("end")}}, std::size_t(grid.steps)},
          PairArrow<double, N>{from, from}};
}

/// Reads [initial] or [boundary]. `check(system, section, q)` refuses a position or returns it; `shapes(system)` draws
/// it.
template <class Sys, int N, class Check, class CheckState, class Shapes>
PreparedScene<Sys> read_mechanical(const Section& scene, const RunContext& context, Presentation<Sys> p,
                                   const VectorKeys& keys, const Check& check, const CheckState& check_state,
                                   const Shapes& shapes) {
  Sys system = read_parameters<Sys>(scene);
  p.shapes = shapes(system);
  if (is_boundary_value(scene, "position and momentum"))
    return boundary_value<Sys>(scene, context, p, [=](const Section& s) {
      return read_vector_boundary<Sys, N>(s, read_parameters<Sys>(s), keys.position, check);
    });
  const Section section = scene.section("initial", "position and momentum");
  auto initial = read_vector_state<N>(section, keys);
  initial.object = check(system, section, initial.object);
  check_state(system, section, initial);
  system.h = read_time(scene).step;
  return simulation(scene, context, system, p, initial, PairArrow<double, N>{initial.object, initial.object});
}

/// Any position, any state.
inline constexpr auto any_position = [](const auto&, const Section&, const auto& q) { return q; };
inline constexpr auto any_state = [](const auto&, const Section&, const auto&) {};

}  // namespace lagroid::app
