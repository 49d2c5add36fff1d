#pragma once
/// What scenes say of bodies that turn about a fixed point.

#include "../../scenes/attitude.hpp"

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/run/motion/presentation.hpp>

#include <vector>

namespace lagroid::app {

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

}  // namespace lagroid::app
