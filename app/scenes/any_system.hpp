#pragma once
/// Scenes of any system: [parameters], [time], [solver], and [initial] or [boundary] in the coordinates of its
/// groupoid.
///
/// A system of one's own needs no code of its own to be read from scenes.
///
///     const ModuleOf<Dido> module = any_module<Dido>("dido", "Dido's problem");
///     const RunResult result = module.run(read_scene("dido.toml", {}), {.record = true});
///
/// Requires a system with a default constructor. Errors: SceneError for a mistake in a scene.

#include "boundary_value.hpp"
#include "system_scene.hpp"

#include <string>
#include <utility>

namespace lagroid::app {

/// [boundary]: the configurations `start` and `end`.
template <DiscreteSystem Sys> BoundaryScene<Sys> read_ends(const Section& scene) {
  const Sys system = read_system<Sys>(scene);
  const Section boundary = scene.section("boundary", "start and end");
  const auto start = read_configuration(system, boundary.section("start", "a configuration"));
  const auto end = read_configuration(system, boundary.section("end", "a configuration"));
  const ArrowFormat<typename Sys::GroupoidType> spoken{system.groupoid};
  return {equal_steps_stage(system, spoken.between(start, end), std::size_t(read_time(scene).steps)), start};
}

/// Reads a scene of any system; `ends` takes the place of `read_ends`.
template <DiscreteSystem Sys>
PreparedScene<Sys> read_any_system(const Section& scene, const RunContext& context, std::string_view name,
                                   Dress<Sys> dress, BoundaryScene<Sys> (*ends)(const Section&) = nullptr) {
  const Sys system = read_system<Sys>(scene);
  const Presentation<Sys> presentation = dressed(system, name, dress);
  if constexpr (Variational<Sys>) {
    if (is_boundary_value(scene, "configuration and momentum"))
      return boundary_value<Sys>(scene, context, presentation, ends ? ends : read_ends<Sys>);
  } else {
    refuse_boundary<Sys>(scene);
  }
  const InitialValue<Sys> initial = read_initial(system, scene, presentation.momentum);
  return simulation(scene, context, system, presentation, initial.state, initial.configuration);
}

/// The module of a system that has no code of its own for scenes; `dress` may add words and pictures.
template <DiscreteSystem Sys>
ModuleOf<Sys> any_module(const std::string& name, const std::string& summary, Dress<Sys> dress = nullptr) {
  return {name, summary,
          [name, dress](const Section& scene, const RunContext& context) {
            return read_any_system<Sys>(scene, context, name, dress);
          },
          [name, dress] { return keys_of<Sys>(name, dress); }};
}

}  // namespace lagroid::app
