// libFuzzer on scenes of bodies and of systems on spheres: whatever the file holds, it is refused by a SceneError, or
// read and begun, and what converges is finite.

#include "bodies/scene_run.hpp"
#include "reading/scene_reader.hpp"
#include "spheres/sphere_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace {

using namespace lagroid;
using namespace lagroid::app;

template <class Read> RunResult run_a_little(Read read) {
  constexpr long most_steps = 2;
  read.pace.steps = std::min(read.pace.steps, most_steps);
  RunResult result;
  drive(*read.motion, read.pace, {.record = true}, result);
  return result;
}

/// None where it is no such scene, or one whose inner steps could take long.
std::optional<RunResult> run(const Section& scene) {
  if (scene.has("body")) return run_a_little(read_bodies(scene, {}));
  const SphereEntry* entry = sphere_system_of(scene);
  if (entry == nullptr || scene.section_or_empty("time").has("tolerance")) return std::nullopt;
  return run_a_little(read_spheres(*entry, scene, {}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto result = run(parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.toml", {}));
    if (!result) return -1;
    if (!result->converged()) return 0;
    for (const auto& series : result->trajectory.series)
      for (const double x : series.values)
        if (!std::isfinite(x)) std::abort();
  } catch (const SceneError&) {
  }
  return 0;
}
