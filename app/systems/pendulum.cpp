#include "mechanical.hpp"
#include "readers.hpp"

namespace lagroid::app {

Task<Pendulum> read_pendulum(const Section& scene, const RunContext& context) {
  auto p = vector_presentation<Pendulum, 1>("pendulum", {"q"}, "rad", {"p"}, "kg m^2/s");
  p.panels = {{"angle", "t", "q", "t", {"q"}},
              {"phase plane", "q", "p", "q", {"p"}},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}}};
  const auto read_system = [](const Section& s) {
    const Section parameters = s.section_or_empty("parameters");
    Pendulum system;
    read_rod_and_bob(parameters, system);
    system.quadrature = read_quadrature(parameters, "midpoint");
    return system;
  };
  return read_mechanical<Pendulum, 1>(scene, context, p, "the angle from the downward vertical", "m l^2 dq/dt",
                                      read_system, any_position, any_state,
                                      [](const Pendulum& system) { return hanging(system.length, "q"); });
}

}  // namespace lagroid::app
