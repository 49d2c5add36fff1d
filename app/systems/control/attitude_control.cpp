#include "../../scenes/any_system.hpp"
#include "../rotations/rotating.hpp"

#include <lagroid/systems/control/attitude_control.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, AttitudeControl);
}

namespace lagroid::app {

namespace {

void dress(Presentation<AttitudeControl>& p, const AttitudeControl& system) {
  using Point = TrajectoryPoint<AttitudeControl>;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "rad/s times the weights' unit";
  p.multipliers = {"lambda"};
  p.extras = {{{"controls", {"w1", "w2", "w3"}, "rad/s", "angular velocity over the arrow", true, {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 3>> w(out);
                 w = system.velocity(point.step.arrow, point.step_size);
               }}};
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"},
                   {"momentum", "body momentum M = W w + lambda n"},
                   {"multipliers", "sign of L + <lambda, phi>, phi = h n.w"}};
  p.panels = turning_panels();
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"spatial momentum error", "t", "deviation", "t", {"drift spatial momentum"}});

  Shape satellite{"box", {0.8, 0.5, 0.3}};
  satellite.attitude = attitude_columns;
  // The end of the axis about which it cannot turn.
  Shape antenna{"sphere", {0.05}};
  antenna.attitude = attitude_columns;
  antenna.offset = {0.7 * system.forbidden(0), 0.7 * system.forbidden(1), 0.7 * system.forbidden(2)};
  antenna.trail = true;
  p.shapes = {satellite, antenna};
}

}  // namespace

const SystemModule& attitude_control_module() {
  static const auto module = any_module<AttitudeControl>(
      "attitude_control", "optimal control of a rotation on SO(3) with one axis forbidden", dress);
  return module;
}

}  // namespace lagroid::app
