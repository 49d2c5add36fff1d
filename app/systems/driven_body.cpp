#include "readers.hpp"
#include "rotating.hpp"

namespace lagroid::app {

Task<DrivenBody> read_driven_body(const Section& scene, const RunContext& context) {
  using Point = TrajectoryPoint<DrivenBody>;
  const Section parameters = scene.section("parameters", "inertia, the three principal moments");
  DrivenBody system;
  system.inertia = read_inertia(parameters);
  if (parameters.has("torque"))
    system.torque =
        Eigen::Map<const Vector<double, 3>>(parameters.numbers("torque", 3, "the thruster's torque").data());
  system.drag = parameters.number_or("drag", 0.1, nonnegative);
  system.rotation = read_rotation_map(parameters);
  system.h = read_time(scene).step;

  Presentation<DrivenBody> p;
  p.name = "driven_body";
  p.has_attitude = true;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.position_of = [](const Point&) { return std::vector<double>{}; };
  p.attitude_of = [](const Point& point) { return quaternion_of(point.configuration); };
  p.extras = {{{"energy", {"H"}, "J", "M.I^{-1} M / 2", false, {}},
               [system](const Point& point, double* out) { *out = system.energy(point.state); }},
              angular_velocity_of<DrivenBody>(system.inertia)};
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"}, {"momentum", "body angular momentum M"}};
  p.shapes = {box_of({system.inertia(0), system.inertia(1), system.inertia(2)})};
  p.panels = turning_panels();
  p.panels.push_back({"energy", "t", "H", "t", {"H"}});
  p.panels.push_back({"energy less work, error", "t", "deviation", "t", {"drift energy less work"}});

  refuse_boundary<DrivenBody>(scene);
  const Section initial = scene.section("initial", "attitude and momentum");
  const State<SO3> state = read_turning(initial);
  const Matrix<double, 3, 3> attitude = read_rotation(initial);
  return simulation(scene, context, system, p, state, attitude);
}

}  // namespace lagroid::app
