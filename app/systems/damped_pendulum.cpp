#include "mechanical.hpp"
#include "readers.hpp"

namespace lagroid::app {

Task<DampedPendulum> read_damped_pendulum(const Section& scene, const RunContext& context) {
  auto p = vector_presentation<DampedPendulum, 1>("damped_pendulum", {"q"}, "rad", {"p"}, "kg m^2/s");
  const Section parameters = scene.section_or_empty("parameters");
  DampedPendulum system;
  read_rod_and_bob(parameters, system);
  system.damping = parameters.number_or("damping", 0.1, nonnegative);
  system.quadrature = read_quadrature(parameters, "midpoint");
  system.h = read_time(scene).step;
  p.extras = {
      {{"energy", {"H"}, "J", "p^2 / (2 m l^2) - m g l cos q", false, {}},
       [system](const TrajectoryPoint<DampedPendulum>& point, double* out) { *out = system.energy(point.state); }}};
  p.shapes = hanging(system.length, "q");
  p.panels = {{"angle", "t", "q", "t", {"q"}},
              {"phase plane", "q", "p", "q", {"p"}},
              {"energy", "t", "H", "t", {"H"}},
              {"energy less work, error", "t", "deviation", "t", {"drift energy less work"}}};
  refuse_boundary<DampedPendulum>(scene);
  const Section section = scene.section("initial", "position and momentum");
  const auto initial = read_vector_state<1>(section, "the angle from the downward vertical", "m l^2 dq/dt");
  return simulation(scene, context, system, p, initial, PairArrow<double, 1>{initial.object, initial.object});
}

}  // namespace lagroid::app
