#include "mechanical.hpp"

#include <lagroid/systems/pendulum.hpp>

namespace lagroid::app {

RunResult run_pendulum(const Section& scene, const RunContext& context) {
  const Section parameters = scene.section_or_empty("parameters");
  Pendulum system;
  system.bob_mass = parameters.number_or("mass", 1, positive);
  system.length = parameters.number_or("length", 1, positive);
  system.gravity = parameters.number_or("gravity", 1);
  system.quadrature = read_quadrature(parameters, "midpoint");
  auto p = vector_presentation<Pendulum, 1>("pendulum", {"q"}, "rad", {"p"}, "kg m^2/s");
  p.panels = {{"angle", "t", "q", "t", {"q"}},
              {"phase plane", "q", "p", "q", {"p"}},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}}};
  const auto initial = read_vector_state<1>(scene.section("initial", "position and momentum"),
                                            "the angle from the downward vertical", "m l^2 dq/dt");
  return run_mechanical<Pendulum, 1>(scene, context, system, p, initial);
}

}  // namespace lagroid::app
