#pragma once
/// Initial-value scenes of any system: [time], [solver] and [output], and the run that they specify.
///
///     const PreparedScene<Sys> prepared = simulation(scene, context, system, presentation, state, configuration);
///     const RunResult result = prepared.run(nullptr);
///
/// Requires that the scene's other keys have been read. For a system of one's own include
/// lagroid/solvers/integrators/integrator_methods.hpp too, else it does not compile. Errors: SceneError for a mistake
/// in the scene or a method that the system does not have, before anything is computed.

#include "../reading/scene_reader.hpp"
#include "prepared_scene.hpp"
#include "scene_keys.hpp"

#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/methods.hpp>

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lagroid::app {

/// [time]: two of step, steps, duration. A step of which only the accuracy is given is the first to be tried.
struct TimeGrid {
  double step = 0;
  long steps = 0;
};
TimeGrid read_time(const Section& scene);
/// `start` of [time]: when the first arrow of a system that depends on time begins, zero where it is not given.
double read_start(const Section& scene);
/// Where the step is not searched for.
void refuse_accuracy(const Section& scene);

/// Refuses [boundary] of a system that has no boundary values.
template <DiscreteSystem Sys> void refuse_boundary(const Section& scene) {
  if (!scene.has("boundary")) return;
  scene.fail("boundary", Forced<Sys>
                             ? "the motions of a forced system make no action stationary; give [initial]"
                             : "the motions of a nonholonomic system make no action stationary; give [initial]");
}

/// How time goes on in an initial-value run: the rest of [time], and [solver].
struct IntegratorChoice {
  IntegratorOptions options;
  double accuracy = 0;  ///< of the first step; 0: its size is given
};
/// `method` of [time]: a method of equal steps, or one of the system's own.
std::string read_method_word(const Section& time, std::span<const DeclaredMethod> own);
/// The method that `mode` and `method` of [time] name; it is one of `own`, or one that is declared for every system.
const DeclaredMethod& read_declared_method(const Section& time, std::span<const DeclaredMethod> own);
/// Refuses what the system does not have; `system` and `remedy` are its words for that.
IntegratorChoice read_integrator(const Section& scene, const Capabilities& able,
                                 std::string_view system = "this system",
                                 std::string_view remedy = "see docs/time.md for those that do");
/// `order`, `composition`: of a fixed step.
Composition read_composition(const Section& time, std::span<const Composition> offered);
/// The fixed steps of a kind, by each of the compositions.
std::vector<Method> composed_methods(std::string_view step, std::span<const Composition> composed_by);
/// All that it would accept.
std::vector<Method> integration_methods(const Capabilities& able);

/// Refuses `reduce`, for a reason.
void refuse_to_reduce(const Section& scene, std::string_view why);

/// [output]: every n-th node is recorded (and the last).
long read_every(const Section& scene);
/// Where the sizes of steps vary.
void refuse_duration(const Section& time);
/// time.tolerance of a method that goes by one; throws SceneError where it is missing, or is given to another method.
std::optional<double> read_tolerance(const Section& time, bool by_tolerance);

/// [[event]]: what is watched for.
std::vector<Event> read_events(const Section& scene);

/// How far a run of steps goes and what it leaves: [time] steps, [output] every and checkpoint, [[event]].
RunExtent read_extent(const Section& scene, const RunContext& context);

/// Whether the scene sets nothing of the solver, which solves each step.
inline bool solved_by_newton(const IntegratorChoice& choice) {
  const IntegratorOptions& o = choice.options;
  const bool vary = (o.mode == TimeMode::adaptive && o.without_root == WithoutRoot::stop) ||
                    o.mode == TimeMode::prescribed || o.mode == TimeMode::controlled;
  return (o.mode == TimeMode::fixed || vary) && o.fixed == StepKind::variational && o.method == StepMethod::newton &&
         o.step.tolerance == 0 && o.step.max_iterations == IntegratorOptions().step.max_iterations;
}
/// Whether Newton's iteration solves equal steps of a given size.
inline bool by_newton_steps(const IntegratorChoice& choice) {
  return choice.options.mode == TimeMode::fixed && choice.accuracy == 0 && solved_by_newton(choice);
}

/// An initial value as a scene states it.
template <DiscreteSystem Sys> struct StatedInitialValue {
  using G = typename Sys::GroupoidType;
  State<G> initial;
  ArrowOf<G> configuration;
  Presentation<Sys> presentation;
  IntegratorChoice choice;
  RunExtent extent;
  /// Of a reduced run, its integrator for a system like this one from another start; null of any other. Throws
  /// std::invalid_argument where what the scene reduces by is no symmetry of that system.
  std::function<std::unique_ptr<Integrator<Sys>>(const Sys&, const State<G>& initial, const ArrowOf<G>& configuration)>
      reduced = nullptr;
  /// Of the method that the system alone has (SystemModule::own_methods), where that makes the steps; else 0.
  int own_order = 0;
  /// Whether the scene sets nothing of its steps beyond their size and number, and watches for nothing.
  bool is_plain() const {
    return by_newton_steps(choice) && choice.options.composition.stages() == 1 && !reduced && own_order == 0 &&
           extent.events.empty();
  }
};

/// The system's motion as the scene specifies it.
template <DiscreteSystem Sys>
std::unique_ptr<Motion> motion_of(const Sys& system, const Presentation<Sys>& presentation,
                                  const State<typename Sys::GroupoidType>& initial,
                                  const ArrowOf<typename Sys::GroupoidType>& configuration,
                                  const IntegratorOptions& options, const Observer<Sys>& observer = nullptr) {
  return std::make_unique<SystemMotion<Sys>>(system, with_step_sizes(presentation, options), watched(system, options),
                                             make_integrator(system, initial, configuration, options), options,
                                             observer);
}

/// Makes the step of the system that of [time] accuracy, where it is given. Returns false where there is none, and
/// the result says so.
template <DiscreteSystem Sys>
bool find_first_step(Sys& system, const State<typename Sys::GroupoidType>& initial, const IntegratorChoice& choice,
                     RunResult& result) {
  if (choice.accuracy == 0) return true;
  const double h = step_for_accuracy(system, initial, choice.accuracy, choice.options);
  if (h > 0) {
    system.h = h;
    result.notes.push_back(fmt::format("first step {:.6g} for time.accuracy = {:.3g}", h, choice.accuracy));
    return true;
  }
  result.status = std::string(to_string(SolveStatus::no_step));
  result.message = "no step from the initial state has the accuracy asked for; give time.step in place of accuracy";
  return false;
}

/// Runs the system.
template <DiscreteSystem Sys>
RunResult simulate(Sys system, const Presentation<Sys>& presentation, const State<typename Sys::GroupoidType>& initial,
                   const ArrowOf<typename Sys::GroupoidType>& configuration, const IntegratorChoice& choice,
                   RunExtent extent, const RunContext& context, const Observer<Sys>& observer) {
  RunResult result;
  if (!find_first_step(system, initial, choice, result)) extent.steps = 0;
  drive(*motion_of(system, presentation, initial, configuration, choice.options, observer), extent, context, result);
  return result;
}

/// The same of the reduction that the scene names; of a system of one's own include ../reductions/reduced_scene.hpp.
template <DiscreteSystem Sys>
PreparedScene<Sys> reduced_simulation(const Section& scene, const RunContext& context, const Sys& system,
                                      const Presentation<Sys>& presentation,
                                      const State<typename Sys::GroupoidType>& initial,
                                      const ArrowOf<typename Sys::GroupoidType>& configuration);

/// The same, to be run later: [time] steps, [solver] and [output] are read from the scene, which must hold no key
/// besides those read.
template <DiscreteSystem Sys>
PreparedScene<Sys> simulation(const Section& scene, const RunContext& context, const Sys& system,
                              const Presentation<Sys>& presentation, const State<typename Sys::GroupoidType>& initial,
                              const ArrowOf<typename Sys::GroupoidType>& configuration) {
  if constexpr (HasReductions<Sys>) {
    if (scene.has(reduce_word)) return reduced_simulation(scene, context, system, presentation, initial, configuration);
  } else {
    refuse_to_reduce(scene, "this system declares nothing by which it is reduced; leave it out");
  }
  const Capabilities able = capabilities_of(system);
  const IntegratorChoice choice = read_integrator(scene, able);
  const RunExtent extent = read_extent(scene, context);
  scene.finish();
  return {system,
          [=](const Observer<Sys>& observer) {
            return simulate(system, presentation, initial, configuration, choice, extent, context, observer);
          },
          [=] { return motion_of(system, presentation, initial, configuration, choice.options); },
          integration_methods(able),
          std::make_shared<const StatedInitialValue<Sys>>(
              StatedInitialValue<Sys>{initial, configuration, presentation, choice, extent})};
}

}  // namespace lagroid::app
