#include "readers.hpp"
#include "rotating.hpp"

namespace lagroid::app {

namespace {

HeavyTop read_system(const Section& scene) {
  const Section parameters = scene.section("parameters", "inertia and weight");
  HeavyTop system;
  system.inertia = read_inertia(parameters);
  const auto weight = parameters.numbers("weight", 3, "weight times the vector to the centre of mass, N m");
  system.weight = Eigen::Map<const Vector<double, 3>>(weight.data());
  system.rotation = read_rotation_map(parameters);
  system.h = read_time(scene).step;
  return system;
}

/// The arrow from the vertical in space to that seen from the body.
ArrowOf<HeavyTop::GroupoidType> configuration_of(const Matrix<double, 3, 3>& attitude) {
  return {attitude, Vector<double, 3>(0, 0, 1)};
}

BoundaryScene<HeavyTop> read_boundary(const Section& scene) {
  const Section boundary = scene.section("boundary", "start and end");
  const auto start = configuration_of(read_rotation(boundary.section("start", "attitude")));
  const auto end = configuration_of(read_rotation(boundary.section("end", "attitude")));
  const HeavyTop system = read_system(scene);
  const auto between = system.groupoid.project(system.groupoid.multiply(system.groupoid.inverse(start), end));
  return {{{system, between}, std::size_t(read_time(scene).steps)}, start};
}

/// A Lagrange top as a cone, another as a box with its centre of mass away from the fixed point; and a point of it.
std::vector<Shape> shapes_of(const HeavyTop& system) {
  const Vector<double, 3> arm = system.weight.norm() > 0 ? system.weight.normalized() : Vector<double, 3>(0, 0, 0);
  Shape body{"cone", {1, 0.4}};
  if (!system.is_lagrange()) {
    body = box_of({system.inertia(0), system.inertia(1), system.inertia(2)});
    body.offset = {arm(0), arm(1), arm(2)};
  }
  body.attitude = attitude_columns;
  Shape point{"sphere", {0.04}};
  point.attitude = attitude_columns;
  point.offset = {1.2 * arm(0), 1.2 * arm(1), 1.2 * arm(2)};
  point.trail = true;
  return {body, point};
}

}  // namespace

Task<HeavyTop> read_heavy_top(const Section& scene, const RunContext& context) {
  Presentation<HeavyTop> p;
  p.name = "heavy_top";
  p.position = {"v1", "v2", "v3"};
  p.position_unit = "1";
  p.has_attitude = true;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.position_of = [](const TrajectoryPoint<HeavyTop>& point) {
    const auto& v = point.state.object;
    return std::vector<double>(v.data(), v.data() + 3);
  };
  p.attitude_of = [](const TrajectoryPoint<HeavyTop>& point) { return quaternion_of(point.configuration.element); };
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"},
                   {"position", "the upward vertical seen from the body, A^T e3"},
                   {"momentum", "body angular momentum M"}};
  p.panels = turning_panels();
  p.panels.insert(p.panels.begin() + 1, {"vertical seen from the body", "t", "v", "t", {"v1", "v2", "v3"}});
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"vertical momentum error", "t", "|M.v - (M.v)_0|", "t", {"drift vertical momentum M.v"}});

  const HeavyTop system = read_system(scene);
  p.extras = {angular_velocity_of<HeavyTop>(system.inertia)};
  p.shapes = shapes_of(system);
  if (is_boundary_value(scene, "attitude and momentum"))
    return boundary_value<HeavyTop>(scene, context, p, read_boundary);
  const Section initial = scene.section("initial", "attitude and momentum");
  const auto configuration = configuration_of(read_rotation(initial));
  State<HeavyTop::GroupoidType> state;
  state.object = system.groupoid.target(configuration);
  state.momentum = Eigen::Map<const Vector<double, 3>>(initial.numbers("momentum", 3, "M1, M2, M3").data());
  return simulation(scene, context, system, p, state, configuration);
}

}  // namespace lagroid::app
