#include "mechanical.hpp"

#include <lagroid/systems/spherical_pendulum.hpp>

namespace lagroid::app {

RunResult run_spherical_pendulum(const Section& scene, const RunContext& context) {
  const Section parameters = scene.section_or_empty("parameters");
  SphericalPendulum system;
  system.bob_mass = parameters.number_or("mass", 1, positive);
  system.length = parameters.number_or("length", 1, positive);
  system.gravity = parameters.number_or("gravity", 1);
  system.quadrature = read_quadrature(parameters, "trapezoid");
  auto p = vector_presentation<SphericalPendulum, 3>("spherical_pendulum", {"x", "y", "z"}, "m", {"px", "py", "pz"},
                                                     "kg m/s");
  p.multipliers = {"lambda"};
  p.conventions["momentum"] = "projected to the tangent of the sphere (RATTLE)";
  p.panels = {{"seen from above", "x", "y", "x", {"y"}, true},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"vertical momentum and constraint", "t", "error", "t", {"drift vertical angular momentum", "residual"}}};
  const Section section = scene.section("initial", "position and momentum");
  auto initial = read_vector_state<3>(section, "x, y, z with z up", "px, py, pz");
  const double norm = initial.object.norm();
  if (std::abs(norm - system.length) > 1e-6 * system.length)
    section.fail("position", norm > 0 ? fmt::format("lies {:.8g} from the pivot, not at the length {:.8g}; scale it to "
                                                    "[{:.10g}, {:.10g}, {:.10g}]",
                                                    norm, system.length, initial.object(0) * system.length / norm,
                                                    initial.object(1) * system.length / norm,
                                                    initial.object(2) * system.length / norm)
                                      : std::string("lies on the pivot"));
  initial.object *= system.length / norm;
  const double radial = initial.object.dot(initial.momentum) / system.length;
  if (std::abs(radial) > 1e-6 * (1 + initial.momentum.norm()))
    section.fail("momentum", fmt::format("has a part {:.6g} along the rod; it must be tangent to the sphere", radial));
  return run_mechanical<SphericalPendulum, 3>(scene, context, system, p, initial);
}

}  // namespace lagroid::app
