#include "../reading/any_system.hpp"

#include <lagroid/systems/damped_pendulum.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<DampedPendulum>& p, const DampedPendulum& system) {
  p.position = {"q"};
  p.position_unit = "rad";
  p.momentum = {"p"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  p.extras = {
      {{"energy", {"H"}, "J", "p^2 / (2 m l^2) - m g l cos q", false, {}},
       [system](const TrajectoryPoint<DampedPendulum>& point, double* out) { *out = system.energy(point.state); }}};
  p.shapes = hanging(system.length, "q");
  p.panels = {{"angle", "t", "q", "t", {"q"}},
              {"phase plane", "q", "p", "q", {"p"}},
              {"energy", "t", "H", "t", {"H"}},
              {"energy less work, error", "t", "deviation", "t", {"drift energy less work"}}};
}

}  // namespace

const SystemModule& damped_pendulum_module() {
  static const auto module = any_module<DampedPendulum>("damped_pendulum", "planar pendulum with damping", dress);
  return module;
}

}  // namespace lagroid::app
