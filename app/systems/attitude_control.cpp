#include "readers.hpp"
#include "rotating.hpp"

namespace lagroid::app {

namespace {

AttitudeControl read_system(const Section& scene) {
  const Section parameters = scene.section_or_empty("parameters");
  AttitudeControl system;
  if (parameters.has("weights")) system.weights = read_positive(parameters, "weights", "weights");
  if (parameters.has("forbidden")) {
    const auto axis = parameters.numbers("forbidden", 3, "the forbidden axis in the body");
    system.forbidden = Eigen::Map<const Vector<double, 3>>(axis.data());
    if (system.forbidden.norm() == 0) parameters.fail("forbidden", "no axis: give a direction other than 0, 0, 0");
    system.forbidden.normalize();
  }
  system.map = read_rotation_map(parameters);
  system.h = read_time(scene).step;
  return system;
}

BoundaryScene<AttitudeControl> read_boundary(const Section& scene) { return read_turn(scene, read_system(scene)); }

}  // namespace

Task<AttitudeControl> read_attitude_control(const Section& scene, const RunContext& context) {
  using Point = TrajectoryPoint<AttitudeControl>;
  Presentation<AttitudeControl> p;
  p.name = "attitude_control";
  p.has_attitude = true;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "rad/s times the weights' unit";
  p.multipliers = {"lambda"};
  p.position_of = [](const Point&) { return std::vector<double>{}; };
  p.attitude_of = [](const Point& point) { return quaternion_of(point.configuration); };
  const AttitudeControl system = read_system(scene);
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
  if (is_boundary_value(scene, "attitude and momentum"))
    return boundary_value<AttitudeControl>(scene, context, p, read_boundary);
  const Section initial = scene.section("initial", "attitude and momentum");
  const State<SO3> state = read_turning(initial);
  const Matrix<double, 3, 3> attitude = read_rotation(initial);
  return simulation(scene, context, system, p, state, attitude);
}

}  // namespace lagroid::app
