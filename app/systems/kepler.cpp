#include "mechanical.hpp"

#include <lagroid/systems/kepler.hpp>

namespace lagroid::app {

RunResult run_kepler(const Section& scene, const RunContext& context) {
  const Section parameters = scene.section_or_empty("parameters");
  Kepler system;
  system.strength = parameters.number_or("strength", 1);
  system.quadrature = read_quadrature(parameters, "trapezoid");
  auto p = vector_presentation<Kepler, 2>("kepler", {"x", "y"}, "m", {"px", "py"}, "m/s");
  p.panels = {{"orbit", "x", "y", "x", {"y"}, true},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"momentum error", "t", "|L - L_0|", "t", {"drift angular momentum"}}};
  const Section section = scene.section("initial", "position and momentum");
  const auto initial = read_vector_state<2>(section, "x, y", "px, py");
  if (initial.object.norm() == 0) section.fail("position", "lies on the centre of attraction; move it away from 0, 0");
  return run_mechanical<Kepler, 2>(scene, context, system, p, initial);
}

}  // namespace lagroid::app
