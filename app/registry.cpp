#include "registry.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
}

}  // namespace lagroid::app
