#include "../../scenes/any_system.hpp"
#include "swinging.hpp"

#include <lagroid/systems/pendulums/pendulum.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, Pendulum);
}

namespace lagroid::app {

namespace {

void dress(Presentation<Pendulum>& p, const Pendulum& system) {
  dress_swinging(p, system);
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
}

}  // namespace

const SystemModule& pendulum_module() {
  static const auto module = any_module<Pendulum>("pendulum", "planar pendulum", dress);
  return module;
}

}  // namespace lagroid::app
