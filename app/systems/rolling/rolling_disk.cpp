#include "../../scenes/arrow_format.hpp"
#include "../../scenes/simulation.hpp"
#include "../../scenes/system_module.hpp"

#include <lagroid/systems/rolling/rolling_disk.hpp>

#include <numbers>

namespace lagroid::app {

namespace {

const KeyOf<NumberArray> rates_key{"rates", {2}, "rad/s", "turning and rolling"};

SystemKeys own_keys() {
  return {parameter_keys<RollingDisk>(), {ArrowFormat<SE2>::declared(ArrowFormat<SE2>::key), rates_key}};
}

PreparedScene<RollingDisk> read(const Section& scene, const RunContext& context) {
  using Point = TrajectoryPoint<RollingDisk>;
  auto system = read_parameters<RollingDisk>(scene);
  system.h = read_time(scene).step;

  Presentation<RollingDisk> p;
  p.name = "rolling_disk";
  p.position = {"x", "y", "heading", "roll"};
  p.position_unit = "m for x, y; rad for the angles";
  p.momentum = {"M", "p1", "p2", "N"};
  p.momentum_unit = "kg m^2/s for M, N; kg m/s for p";
  p.multipliers = {"lambda1", "lambda2"};
  p.position_of = [](const Point& point) {
    const auto& [pose, roll] = point.configuration;
    auto position = ArrowFormat<SE2>::coordinates(pose, {});
    position.push_back(SO2::log(roll)(0));
    return position;
  };
  p.extras = {{{"rates", {"w", "s"}, "rad/s", "of turning and of rolling", false, {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 2>> rates(out);
                 rates = system.velocities(point.state);
               }}};
  p.conventions = {{"position",
                    "x, y of the point of contact, the angle from the x axis to where it rolls, and how far "
                    "it has rolled, both from -pi to pi"},
                   {"momentum", "in the disk's frame: about the vertical, ahead, to the left, about its axis"},
                   {"multipliers", "impulses of the reaction at the object the arrow starts from"}};
  Shape disk = on_the_plane({"disk", {system.radius, 0.1 * system.radius}}, system.radius);
  disk.turns.push_back({{1, 0, 0}, -0.5 * std::numbers::pi});
  disk.turns.push_back({{0, 0, 1}, "roll"});
  disk.trail = true;
  p.shapes = {disk, turning_plate(0)};
  p.panels = {{"path of the point of contact", "x", "y", "x", {"y"}, true},
              {"heading and roll", "t", "angle, rad", "t", {"heading", "roll"}},
              {"rates", "t", "w, s", "t", {"w", "s"}},
              {"constraint residual", "t", "largest |phi|", "t", {"residual"}},
              {"energy error", "t", "|E - E_0|", "t", {"drift energy"}}};

  refuse_boundary<RollingDisk>(scene);
  const Section initial = scene.section("initial", "position and rates");
  const Matrix<double, 3, 3> pose = ArrowFormat<SE2>::read(initial, ArrowFormat<SE2>::key);
  const auto given = read_key(initial, rates_key);
  const ArrowOf<RollingDisk::GroupoidType> configuration{pose, Matrix<double, 2, 2>::Identity()};
  return simulation(scene, context, system, p, system.rolling(given[0], given[1]), configuration);
}

}  // namespace

const SystemModule& rolling_disk_module() {
  static const ModuleOf<RollingDisk> module("rolling_disk", "upright disk rolling on the plane (nonholonomic)", read,
                                            own_keys);
  return module;
}

}  // namespace lagroid::app
