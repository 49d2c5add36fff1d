#include "readers.hpp"
#include "rotating.hpp"

namespace lagroid::app {

namespace {

RigidBody read_system(const Section& scene) {
  const Section parameters = scene.section("parameters", "inertia, the three principal moments");
  RigidBody system;
  system.inertia = read_inertia(parameters);
  system.rotation = read_rotation_map(parameters);
  system.h = read_time(scene).step;
  return system;
}

BoundaryScene<RigidBody> read_boundary(const Section& scene) { return read_turn(scene, read_system(scene)); }

}  // namespace

Task<RigidBody> read_rigid_body(const Section& scene, const RunContext& context) {
  Presentation<RigidBody> p;
  p.name = "rigid_body";
  p.has_attitude = true;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.position_of = [](const TrajectoryPoint<RigidBody>&) { return std::vector<double>{}; };
  p.attitude_of = [](const TrajectoryPoint<RigidBody>& point) { return quaternion_of(point.configuration); };
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"}, {"momentum", "body angular momentum M"}};
  p.panels = {{"body angular momentum", "t", "M", "t", {"M1", "M2", "M3"}},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"spatial momentum error", "t", "|A M - (A M)_0|", "t", {"drift spatial momentum A M"}}};

  const RigidBody system = read_system(scene);
  if (is_boundary_value(scene, "attitude and momentum"))
    return boundary_value<RigidBody>(scene, context, p, read_boundary);
  const Section initial = scene.section("initial", "attitude and momentum");
  State<SO3> state;
  state.momentum = Eigen::Map<const Vector<double, 3>>(initial.numbers("momentum", 3, "M1, M2, M3").data());
  const Matrix<double, 3, 3> attitude = read_rotation(initial);
  return simulation(scene, context, system, p, state, attitude);
}

}  // namespace lagroid::app
