#pragma once
/// Initial-value scenes that name a reduction (`reduce = "..."`): steps are those of the reduced system, from where the
/// initial state of the full one descends to, and what is recorded is the full motion.
///
/// Requires the integrators of the reduced systems: lagroid/solvers/integrators/integrator_methods.hpp for a system of
/// one's own; those of systems/ are compiled. Errors: SceneError where the scene's symmetry is none, with the sample
/// that shows it, where it leaves the initial object where it is, or for a method that the reduced system does not
/// have.

#include "../scenes/simulation.hpp"

#include <lagroid/run/reduced_motion.hpp>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

template <class Declared, DiscreteSystem Sys>
PreparedScene<Sys> simulation_reduced_by(const Declared& declared, const Section& scene, const RunContext& context,
                                         const Sys& system, const Presentation<Sys>& presentation,
                                         const State<typename Sys::GroupoidType>& initial,
                                         const ArrowOf<typename Sys::GroupoidType>& configuration) {
  using Down = Reconstruction<Sys, Declared>;
  const auto arrows = arrows_about(system.groupoid, initial.object);
  const Down down = [&] {
    try {
      return Down(declared, system, initial, configuration);
    } catch (const NotFree& nothing_to_reduce_to) {
      scene.fail(reduce_word, nothing_to_reduce_to.what());
    }
  }();
  if (const DescentReport found = examine_reduction(down, arrows); !found.descends())
    scene.fail(reduce_word, fmt::format("\"{}\" is no symmetry of this system: {}", declared.name, found.sentence()));
  const Capabilities able = capabilities_of(down.system());
  const IntegratorChoice choice =
      read_integrator(scene, able, fmt::format("the system reduced by \"{}\"", declared.name),
                      fmt::format("leave out {} for those of the full one", reduce_word));
  const RunExtent extent = read_extent(scene, context);
  scene.finish();
  const auto motion = [=](const Sys& stepped, const Observer<Sys>& observer) {
    return std::make_unique<ReducedMotion<Sys, Declared>>(declared, stepped,
                                                          Down(declared, stepped, initial, configuration), presentation,
                                                          arrows, choice.options, observer);
  };
  const auto run = [=](const Observer<Sys>& observer) {
    RunResult result;
    RunExtent reached = extent;
    Sys stepped = system;
    if constexpr (HasTimeStep<Sys>) {
      auto below = down.system();
      if (!find_first_step(below, down.initial(), choice, result)) reached.steps = 0;
      stepped.h = below.h;
    }
    drive(*motion(stepped, observer), reached, context, result);
    return result;
  };
  const auto reduced = [=](const Sys& stepped, const State<typename Sys::GroupoidType>& from,
                           const ArrowOf<typename Sys::GroupoidType>& reached) -> std::unique_ptr<Integrator<Sys>> {
    const Down there(declared, stepped, from, reached);
    if (const DescentReport found = examine_reduction(there, arrows); !found.descends())
      throw std::invalid_argument(
          fmt::format("\"{}\" is no symmetry of such a system: {}", declared.name, found.sentence()));
    return std::make_unique<ReducedIntegrator<Sys, Declared>>(there, choice.options);
  };
  return {system,
          run,
          [=] { return motion(system, nullptr); },
          integration_methods(able),
          std::make_shared<const StatedInitialValue<Sys>>(
              StatedInitialValue<Sys>{initial, configuration, presentation, choice, extent, reduced}),
          std::string(declared.name)};
}

template <DiscreteSystem Sys>
PreparedScene<Sys> reduced_simulation(const Section& scene, const RunContext& context, const Sys& system,
                                      const Presentation<Sys>& presentation,
                                      const State<typename Sys::GroupoidType>& initial,
                                      const ArrowOf<typename Sys::GroupoidType>& configuration) {
  const std::string name = read_key(scene, reduce_key(names_of_reductions<Sys>()));
  std::optional<PreparedScene<Sys>> prepared;
  for_each_reduction<Sys>([&](const auto& declared) {
    if (declared.name == name)
      prepared = simulation_reduced_by(declared, scene, context, system, presentation, initial, configuration);
  });
  return *prepared;
}

}  // namespace lagroid::app
