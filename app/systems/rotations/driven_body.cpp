#include "../../scenes/any_system.hpp"
#include "rotating.hpp"

#include <lagroid/systems/rotations/driven_body.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<DrivenBody>& p, const DrivenBody& system) {
  using Point = TrajectoryPoint<DrivenBody>;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.extras = {{{"energy", {"H"}, "J", "M.I^{-1} M / 2", false, {}},
               [system](const Point& point, double* out) { *out = system.energy(point.state); }},
              angular_velocity_of<DrivenBody>(system.inertia)};
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"}, {"momentum", "body angular momentum M"}};
  p.shapes = {box_of({system.inertia(0), system.inertia(1), system.inertia(2)})};
  p.panels = turning_panels();
  p.panels.push_back({"energy", "t", "H", "t", {"H"}});
  p.panels.push_back({"energy less work, error", "t", "deviation", "t", {"drift energy less work"}});
}

}  // namespace

const SystemModule& driven_body_module() {
  static const auto module = any_module<DrivenBody>("driven_body", "rigid body with thrust and drag on SO(3)", dress);
  return module;
}

}  // namespace lagroid::app
