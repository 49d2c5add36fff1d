#include "../../scenes/any_system.hpp"
#include "swinging.hpp"

#include <lagroid/systems/pendulums/damped_pendulum.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<DampedPendulum>& p, const DampedPendulum& system) {
  dress_swinging(p, system);
  p.extras = {
      {{"energy", {"H"}, "J", "p^2 / (2 m l^2) - m g l cos q", false, {}},
       [system](const TrajectoryPoint<DampedPendulum>& point, double* out) { *out = system.energy(point.state); }}};
  p.panels.push_back({"energy", "t", "H", "t", {"H"}});
  p.panels.push_back({"energy less work, error", "t", "deviation", "t", {"drift energy less work"}});
}

}  // namespace

const SystemModule& damped_pendulum_module() {
  static const auto module = any_module<DampedPendulum>("damped_pendulum", "planar pendulum with damping", dress);
  return module;
}

}  // namespace lagroid::app
