#include "../scenes/system_module.hpp"
#include "mechanical.hpp"

#include <lagroid/systems/kepler.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, Kepler);
}

namespace lagroid::app {

namespace {

const VectorKeys state_keys{{"position", {2}, "m", "x, y"}, {"momentum", {2}, "m/s", "px, py, of a unit mass"}};

PreparedScene<Kepler> read(const Section& scene, const RunContext& context) {
  auto p = vector_presentation<Kepler, 2>("kepler", {"x", "y"}, "m", {"px", "py"}, "m/s");
  p.panels = {{"orbit", "x", "y", "x", {"y"}, true},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}},
              {"momentum error", "t", "|L - L_0|", "t", {"drift angular momentum"}}};
  const auto off_centre = [](const Kepler&, const Section& section, const Vector<double, 2>& q) {
    if (q.norm() == 0) section.fail("position", "lies on the centre of attraction; move it away from 0, 0");
    return q;
  };
  const auto shapes = [](const Kepler&) {
    Shape planet{"sphere", {0.05}};
    planet.position = {"x", "y", 0.0};
    planet.trail = true;
    return std::vector<Shape>{{"sphere", {0.1}}, planet};
  };
  return read_mechanical<Kepler, 2>(scene, context, p, state_keys, off_centre, any_state, shapes);
}

}  // namespace

const SystemModule& kepler_module() {
  static const ModuleOf<Kepler> module("kepler", "planar Kepler problem", read,
                                       [] { return keys_of<Kepler>(state_keys); });
  return module;
}

}  // namespace lagroid::app
