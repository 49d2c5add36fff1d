#include "mechanical.hpp"
#include "readers.hpp"

namespace lagroid::app {

Task<DrivenPendulum> read_driven_pendulum(const Section& scene, const RunContext& context) {
  auto p = vector_presentation<DrivenPendulum, 1>("driven_pendulum", {"q"}, "rad", {"p"}, "kg m^2/s");
  const Section parameters = scene.section_or_empty("parameters");
  DrivenPendulum system;
  read_rod_and_bob(parameters, system);
  system.frequency = parameters.number_or("frequency", 1);
  system.torque = parameters.number_or("torque", 0);
  system.amplitude = parameters.number_or("amplitude", 0);
  system.time = scene.section_or_empty("time").number_or("start", 0);
  system.h = read_time(scene).step;
  if (system.time + 0.5 * system.h == system.time)
    scene.section_or_empty("time").fail("start", "is so late that a step is lost in its rounding; begin earlier");
  p.extras = {{{"energy", {"H"}, "J", "p^2 / (2 m l^2) + U(q, t)", false, {}},
               [system](const TrajectoryPoint<DrivenPendulum>& point, double* out) {
                 *out = system.energy(point.state, point.time);
               }}};
  p.shapes = hanging(system.length, "q");
  p.panels = {{"angle", "t", "q", "t", {"q"}}, {"phase plane", "q", "p", "q", {"p"}}, {"energy", "t", "H", "t", {"H"}}};
  refuse_boundary<DrivenPendulum>(scene);
  const Section section = scene.section("initial", "position and momentum");
  const auto initial = read_vector_state<1>(section, "the angle from the downward vertical", "m l^2 dq/dt");
  return simulation(scene, context, system, p, initial, PairArrow<double, 1>{initial.object, initial.object});
}

}  // namespace lagroid::app
