// libFuzzer on scenes of bodies: whatever the file holds, it is refused by a SceneError, or read and begun, and what
// converges is finite.

#include "scene_reader.hpp"
#include "scenes/scene_run.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lagroid::app;
  try {
    const Section scene = parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.toml", {});
    if (!scene.has("body")) return -1;
    const RunResult result = run_bodies(scene, {.record = true}, /*most_steps=*/2);
    if (!result.converged()) return 0;
    for (const auto& series : result.trajectory.series)
      for (const double x : series.values)
        if (!std::isfinite(x)) std::abort();
  } catch (const SceneError&) {
  }
  return 0;
}
