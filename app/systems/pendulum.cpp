#include "../reading/any_system.hpp"

#include <lagroid/systems/pendulum.hpp>

namespace lagroid::app {

namespace {

void dress(Presentation<Pendulum>& p, const Pendulum& system) {
  p.position = {"q"};
  p.position_unit = "rad";
  p.momentum = {"p"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  p.panels = {{"angle", "t", "q", "t", {"q"}},
              {"phase plane", "q", "p", "q", {"p"}},
              {"energy error", "t", "|H - H_0|", "t", {"drift energy"}}};
  p.shapes = hanging(system.length, "q");
}

}  // namespace

const SystemModule& pendulum_module() {
  static const auto module = any_module<Pendulum>("pendulum", "planar pendulum", dress);
  return module;
}

}  // namespace lagroid::app
