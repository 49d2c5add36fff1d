// libFuzzer on scenes of bodies and of systems on spheres: whatever the file holds, it is refused by a SceneError, or
// read and begun, and what converges is finite.

#include "families/family.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace {

using namespace lagroid;
using namespace lagroid::app;

/// None where it is no motion, or one whose inner steps could take long.
std::optional<RunResult> run(const Section& scene) {
  const SceneFamily& family = family_of(scene);
  if (family.command() != "run" || scene.section_or_empty("time").has("tolerance")) return std::nullopt;
  MotionScene read = family.read(scene, {});
  constexpr long most_steps = 2;
  read.extent.steps = std::min(read.extent.steps, most_steps);
  RunResult result;
  drive(*read.motion, read.extent, {.record = true}, result);
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  // Of the families those that compile quickly: systems are read by the same code.
  use_families({&systems_family(), &spheres_family(), &bodies_family()});
  return 0;
}

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
