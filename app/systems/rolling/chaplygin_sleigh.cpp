#include "../../scenes/arrow_format.hpp"
#include "../../scenes/simulation.hpp"
#include "../../scenes/system_module.hpp"

#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>

namespace lagroid::app {

namespace {

const KeyOf<NumberArray> velocity{"velocity", {2}, "", "turning (rad/s), ahead (m/s)"};

SystemKeys own_keys() {
  return {parameter_keys<ChaplyginSleigh>(), {ArrowFormat<SE2>::declared(ArrowFormat<SE2>::key), velocity}};
}

PreparedScene<ChaplyginSleigh> read(const Section& scene, const RunContext& context) {
  using Point = TrajectoryPoint<ChaplyginSleigh>;
  auto system = read_parameters<ChaplyginSleigh>(scene);
  system.h = read_time(scene).step;

  Presentation<ChaplyginSleigh> p;
  p.name = "chaplygin_sleigh";
  p.position = {"x", "y", "heading"};
  p.position_unit = "m for x, y; rad for the heading";
  p.momentum = {"M", "p1", "p2"};
  p.momentum_unit = "kg m^2/s for M; kg m/s for p";
  p.multipliers = {"lambda"};
  p.position_of = [](const Point& point) { return ArrowFormat<SE2>::coordinates(point.configuration, {}); };
  p.extras = {{{"velocities", {"w", "v1"}, "rad/s for w, m/s for v1", "turning, and the blade's ahead", false, {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 2>> velocities(out);
                 velocities = system.velocities(point.state);
               }}};
  p.conventions = {{"position", "pose A_k = A_{k-1} g_k of the blade: x, y and the angle from the x axis to its edge"},
                   {"momentum", "body momentum: about the blade, ahead, to the left"},
                   {"multipliers", "impulse of the reaction at the object the arrow starts from"}};
  p.shapes = {on_the_plane({"box", {0.6, 0.3, 0.05}}, 0.1), on_the_plane({"box", {0.3, 0.02, 0.15}}, 0.05)};
  p.shapes[0].offset[0] = system.offset;
  p.shapes[1].trail = true;
  p.panels = {{"path of the blade", "x", "y", "x", {"y"}, true},
              {"heading", "t", "angle, rad", "t", {"heading"}},
              {"velocities", "t", "w, v1", "t", {"w", "v1"}},
              {"energy error", "t", "|E - E_0|", "t", {"drift energy"}},
              {"momentum equation, error", "t", "deviation", "t", {"drift momentum equation of turning"}}};

  refuse_boundary<ChaplyginSleigh>(scene);
  const Section initial = scene.section("initial", "position and velocity");
  const Matrix<double, 3, 3> pose = ArrowFormat<SE2>::read(initial, ArrowFormat<SE2>::key);
  const auto given = read_key(initial, velocity);
  return simulation(scene, context, system, p, system.sliding(given[0], given[1]), pose);
}

}  // namespace

const SystemModule& chaplygin_sleigh_module() {
  static const ModuleOf<ChaplyginSleigh> module("chaplygin_sleigh", "body sliding on a blade (nonholonomic)", read,
                                                own_keys);
  return module;
}

}  // namespace lagroid::app
