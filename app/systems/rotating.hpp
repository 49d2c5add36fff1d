#pragma once
/// What scenes say of bodies that turn about a fixed point.

#include "../reading/boundary_value.hpp"
#include "attitude.hpp"
#include "group_map.hpp"

#include <lagroid/systems/rotation_map.hpp>

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace lagroid::app {

/// `momentum`: the body angular momentum.
inline State<SO3> read_turning(const Section& initial) {
  State<SO3> state;
  state.momentum = Eigen::Map<const Vector<double, 3>>(initial.numbers("momentum", 3, "M1, M2, M3").data());
  return state;
}

/// I^{-1} M at every node.
template <class Sys> ExtraColumns<Sys> angular_velocity_of(const Vector<double, 3>& inertia) {
  return {{"angular_velocity", {"w1", "w2", "w3"}, "rad/s", "of the body, in its frame", false, {}},
          [inertia](const TrajectoryPoint<Sys>& point, double* out) {
            Eigen::Map<Vector<double, 3>> w(out);
            w = point.state.momentum.cwiseQuotient(inertia);
          }};
}

/// Attitude, angular velocity and momentum of a body with the columns w1... and M1...
inline std::vector<Panel> turning_panels() {
  return {attitude_panel(),
          {"angular velocity in the body", "t", "w", "t", {"w1", "w2", "w3"}},
          {"angular momentum in the body", "t", "M", "t", {"M1", "M2", "M3"}}};
}

/// `rotation`: exp, which is the default, or cayley.
inline RotationMap read_rotation_map(const Section& parameters) { return read_group_map(parameters, "rotation"); }

/// [boundary] of a system on SO(3): the attitudes at the start and at the end.
template <class Sys> BoundaryScene<Sys> read_turn(const Section& scene, const Sys& system) {
  const Section boundary = scene.section("boundary", "start and end");
  const Matrix<double, 3, 3> start = read_rotation(boundary.section("start", "attitude"));
  const Matrix<double, 3, 3> end = read_rotation(boundary.section("end", "attitude"));
  return {{{system, SO3::project(Matrix<double, 3, 3>(start.transpose() * end))}, std::size_t(read_time(scene).steps)},
          start};
}

}  // namespace lagroid::app
