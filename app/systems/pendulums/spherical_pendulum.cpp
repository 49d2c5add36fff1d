#include "../../scenes/system_module.hpp"
#include "../mechanical.hpp"

#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, SphericalPendulum);
}

namespace lagroid::app {

namespace {

const VectorKeys state_keys{{"position", {3}, "m", "x, y, z on the sphere, z up"},
                            {"momentum", {3}, "kg m/s", "px, py, pz, tangent to the sphere"}};

PreparedScene<SphericalPendulum> read(const Section& scene, const RunContext& context) {
  auto p = vector_presentation<SphericalPendulum, 3>("spherical_pendulum", {"x", "y", "z"}, "m", {"px", "py", "pz"},
                                                     "kg m/s");
  p.multipliers = {"lambda"};
  p.conventions["momentum"] = "projected to the tangent of the sphere (RATTLE)";
  p.panels = {{"seen from above", "x", "y", "x", {"y"}, true},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"vertical momentum and constraint", "t", "error", "t", {"drift vertical angular momentum", "residual"}}};
  const auto on_sphere = [](const SphericalPendulum& system, const Section& section,
                            const Vector<double, 3>& q) -> Vector<double, 3> {
    const double length = system.length;
    const double norm = q.norm();
    if (norm == 0 || (std::abs(norm - length) > 1e-6 * length && !section.interpolated()))
      section.fail("position",
                   norm > 0
                       ? fmt::format("lies {:.8g} from the pivot, not at the length {:.8g}; scale it to "
                                     "[{:.10g}, {:.10g}, {:.10g}]",
                                     norm, length, q(0) * length / norm, q(1) * length / norm, q(2) * length / norm)
                       : std::string("lies on the pivot"));
    return q * (length / norm);
  };
  const auto tangent = [](const SphericalPendulum& system, const Section& section, const State<Pair<3>>& s) {
    const double radial = s.object.dot(s.momentum) / system.length;
    if (std::abs(radial) > 1e-6 * (1 + s.momentum.norm()))
      section.fail("momentum",
                   fmt::format("has a part {:.6g} along the rod; it must be tangent to the sphere", radial));
  };
  const auto shapes = [](const SphericalPendulum& system) {
    Shape rod{"rod", {system.length, 0.015 * system.length}};
    rod.to = {"x", "y", "z"};
    Shape bob{"sphere", {0.08 * system.length}};
    bob.position = {"x", "y", "z"};
    bob.trail = true;
    return std::vector<Shape>{rod, bob};
  };
  return read_mechanical<SphericalPendulum, 3>(scene, context, p, state_keys, on_sphere, tangent, shapes);
}

}  // namespace

const SystemModule& spherical_pendulum_module() {
  static const ModuleOf<SphericalPendulum> module("spherical_pendulum",
                                                  "spherical pendulum, R^3 with an object constraint", read,
                                                  [] { return keys_of<SphericalPendulum>(state_keys); });
  return module;
}

}  // namespace lagroid::app
