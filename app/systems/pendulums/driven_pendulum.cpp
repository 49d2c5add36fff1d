#include "../../scenes/any_system.hpp"
#include "swinging.hpp"

#include <lagroid/solvers/boundary/boundary_methods.hpp>
#include <lagroid/systems/pendulums/driven_pendulum.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<DrivenPendulum>& p, const DrivenPendulum& system) {
  dress_swinging(p, system);
  p.extras = {{{"energy", {"H"}, "J", "p^2 / (2 m l^2) + U(q, t)", false, {}},
               [system](const TrajectoryPoint<DrivenPendulum>& point, double* out) {
                 *out = system.energy(point.state, point.time);
               }}};
  p.panels.push_back({"energy", "t", "H", "t", {"H"}});
}

}  // namespace

const SystemModule& driven_pendulum_module() {
  static const auto module = any_module<DrivenPendulum>(
      "driven_pendulum", "planar pendulum under a periodic torque or on a shaking support", dress);
  return module;
}

}  // namespace lagroid::app
