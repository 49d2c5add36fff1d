#pragma once
/// The systems a scene can name.

#include "run_result.hpp"
#include "scene_reader.hpp"
#include "simulation.hpp"

#include <span>
#include <string_view>

namespace lagroid::app {

struct SystemEntry {
  std::string_view name;
  std::string_view summary;
  RunResult (*run)(const Section& scene, const RunContext& context);
};

/// All systems, in the order they are listed to users.
std::span<const SystemEntry> systems();

/// Reads `system` and runs it. Every key of the scene is read and checked before anything is computed.
RunResult run_scene(const Section& scene, const RunContext& context);

RunResult run_plate_ball(const Section& scene, const RunContext& context);
RunResult run_rigid_body(const Section& scene, const RunContext& context);
RunResult run_heavy_top(const Section& scene, const RunContext& context);
RunResult run_pendulum(const Section& scene, const RunContext& context);
RunResult run_kepler(const Section& scene, const RunContext& context);
RunResult run_spherical_pendulum(const Section& scene, const RunContext& context);

}  // namespace lagroid::app
