#include "../registry.hpp"
#include "attitude.hpp"

#include <lagroid/systems/rigid_body.hpp>

namespace lagroid::app {

RunResult run_rigid_body(const Section& scene, const RunContext& context) {
  const Section parameters = scene.section("parameters", "inertia, the three principal moments");
  RigidBody system;
  const auto inertia = parameters.numbers("inertia", 3, "principal moments");
  for (const double moment : inertia)
    if (!(moment > 0)) parameters.fail("inertia", fmt::format("principal moments must be positive, got {}", moment));
  system.inertia = Eigen::Map<const Vector<double, 3>>(inertia.data());
  system.rotation = parameters.choice_or("rotation", "exp", {"exp", "cayley"}) == "exp" ? RotationMap::exponential
                                                                                        : RotationMap::cayley;
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

  const Section initial = scene.section("initial", "attitude and momentum");
  State<SO3> state;
  state.momentum = Eigen::Map<const Vector<double, 3>>(initial.numbers("momentum", 3, "M1, M2, M3").data());
  const auto attitude = initial.has("attitude") ? initial.attitude("attitude") : std::array<double, 4>{1, 0, 0, 0};
  const TimeGrid grid = read_time(scene);
  system.h = grid.step;
  const StepperChoice choice = read_stepper(scene.section_or_empty("solver"));
  const long every = read_every(scene, context);
  scene.finish();
  return simulate(system, p, state, rotation_from(attitude), grid.steps, choice, every, context);
}

}  // namespace lagroid::app
