#include "registry.hpp"

#include <array>

namespace lagroid::app {

std::span<const SystemEntry> systems() {
  static constexpr std::array<SystemEntry, 6> all{{
      {"plate_ball", "optimal control of a ball rolling on a rotating plate", run_plate_ball},
      {"rigid_body", "free rigid body on SO(3)", run_rigid_body},
      {"heavy_top", "rigid body with a fixed point under gravity, SO(3) acting on S^2", run_heavy_top},
      {"pendulum", "planar pendulum", run_pendulum},
      {"kepler", "planar Kepler problem", run_kepler},
      {"spherical_pendulum", "spherical pendulum, R^3 with an object constraint", run_spherical_pendulum},
  }};
  return all;
}

RunResult run_scene(const Section& scene, const RunContext& context) {
  std::vector<std::string> names;
  for (const auto& entry : systems()) names.emplace_back(entry.name);
  const std::string name = scene.choice("system", names);
  for (const auto& entry : systems())
    if (entry.name == name) return entry.run(scene, context);
  scene.fail("system", "not a system");
}

}  // namespace lagroid::app
