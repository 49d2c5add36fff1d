#include "../reading/any_system.hpp"

#include <lagroid/systems/driven_pendulum.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<DrivenPendulum>& p, const DrivenPendulum& system) {
  p.position = {"q"};
  p.position_unit = "rad";
  p.momentum = {"p"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  p.extras = {{{"energy", {"H"}, "J", "p^2 / (2 m l^2) + U(q, t)", false, {}},
               [system](const TrajectoryPoint<DrivenPendulum>& point, double* out) {
                 *out = system.energy(point.state, point.time);
               }}};
  p.shapes = hanging(system.length, "q");
  p.panels = {{"angle", "t", "q", "t", {"q"}}, {"phase plane", "q", "p", "q", {"p"}}, {"energy", "t", "H", "t", {"H"}}};
}

}  // namespace

const SystemModule& driven_pendulum_module() {
  static const auto module = any_module<DrivenPendulum>(
      "driven_pendulum", "planar pendulum under a periodic torque or on a shaking support", dress);
  return module;
}

}  // namespace lagroid::app
