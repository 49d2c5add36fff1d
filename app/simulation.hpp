#pragma once
/// Initial-value runs of any system.

#include "interrupt.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "scene_reader.hpp"
#include "task.hpp"

#include <lagroid/core/discrete_energy.hpp>
#include <lagroid/core/split_system.hpp>
#include <lagroid/solvers/integrator.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/solvers/step_control.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace lagroid::app {

/// [time]: two of step, steps, duration. A step of which only the accuracy is given is the first to be tried.
struct TimeGrid {
  double step = 0;
  long steps = 0;
};
TimeGrid read_time(const Section& scene);
/// Where the step is not searched for.
void refuse_accuracy(const Section& scene);

/// How time goes on in an initial-value run: the rest of [time], and [solver].
struct MarchChoice {
  MarchOptions options;
  double accuracy = 0;  ///< of the first step; 0: its size is given
};
/// Which of them a system has.
struct Abilities {
  bool variational = false;
  bool timed = false;
  bool time_scale = false;
  bool split = false;
};
template <class Sys>
inline constexpr Abilities abilities_of{Variational<Sys>, Timed<Sys>, Timed<Sys>&& HasTimeScale<Sys>, SplitSystem<Sys>};
/// Refuses what the system does not have.
MarchChoice read_march(const Section& scene, const Abilities& able);

/// [output]: every n-th node is recorded (and the last); 0 when nothing is.
long read_every(const Section& scene, const RunContext& context);

/// What to say of a step that failed.
std::string step_failure(const StepReport& report, long step, double time, TimeMode mode);
/// What to say of steps whose size was not what the mode asks for.
std::string without_root_note(long count, long steps, WithoutRoot instead);
/// In words, what a method declares of itself.
std::string description(const MethodTraits& method);

/// The point with its momentum made tangent to the object constraints, as it is reported.
template <DiscreteSystem Sys> TrajectoryPoint<Sys> reported(const Sys& system, TrajectoryPoint<Sys> point) {
  point.state.momentum = tangent_momentum(system, point.state);
  return point;
}

/// What the ledger watches: the system's own quantities, and E_d where the steps keep it or vary.
template <DiscreteSystem Sys> std::vector<Quantity<Sys>> watched(const Sys& system, const MarchOptions& options) {
  auto all = system.quantities();
  if constexpr (Timed<Sys>) {
    if (options.mode == TimeMode::adaptive && !TimeDependent<Sys>) {
      const bool kept = options.without_root == WithoutRoot::stop;
      all.push_back(discrete_energy_quantity(system, kept ? Promise::conserved : Promise::bounded));
    }
  }
  return all;
}

/// The presentation with the step sizes, where they vary: a series and a panel.
template <DiscreteSystem Sys> Presentation<Sys> with_step_sizes(Presentation<Sys> p, const MarchOptions& options) {
  if (options.mode == TimeMode::fixed) return p;
  p.extras.push_back({{"step_size", {"h"}, "s", "step size of the arrow", true, {}},
                      [](const TrajectoryPoint<Sys>& point, double* out) { *out = point.step_size; }});
  p.panels.push_back({"step size", "t", "h", "t", {"h"}});
  if (options.mode == TimeMode::adaptive && !TimeDependent<Sys>)
    p.panels.push_back({"discrete energy error", "t", "|E_d - first|", "t", {"drift discrete energy E_d"}});
  return p;
}

/// Runs the system; a step that fails, Ctrl-C or SIGTERM ends the run with what was computed so far.
template <DiscreteSystem Sys>
RunResult simulate(Sys system, const Presentation<Sys>& own, const State<typename Sys::GroupoidType>& initial,
                   const ArrowOf<typename Sys::GroupoidType>& configuration, long steps, const MarchChoice& choice,
                   long every, const RunContext& context, const Observer<Sys>& observer) {
  const auto start = std::chrono::steady_clock::now();
  const Presentation<Sys> presentation = with_step_sizes(own, choice.options);
  RunResult result;
  result.steps_asked = steps;
  if (choice.accuracy > 0) {
    const double h = step_for_accuracy(system, initial, choice.accuracy, choice.options);
    if (h > 0) {
      system.h = h;
      result.notes.push_back(fmt::format("first step {:.6g} for time.accuracy = {:.3g}", h, choice.accuracy));
    } else {
      result.status = std::string(to_string(SolveStatus::no_step));
      result.message = "no step from the initial state has the accuracy asked for; give time.step in place of accuracy";
      steps = 0;
    }
  }
  Recorder<Sys> recorder(system, presentation, watched(system, choice.options), every, observer);
  const auto march = make_march(system, initial, configuration, choice.options);
  result.method = description(march->traits());
  const auto watch_stage = [&](const Step<Sys>& step, double from, double size) {
    recorder.watch_constraint(step, from, size);
  };
  recorder.observe(reported(system, march->point()));
  {
    Progress progress(presentation.name, steps, context.progress);
    const InterruptGuard guard;
    for (long k = 1; k <= steps; ++k) {
      const StepReport report = march->advance();
      result.iterations += report.iterations;
      result.ledger.most_iterations = std::max(result.ledger.most_iterations, report.iterations);
      if (!report.converged()) {
        result.status = std::string(to_string(report.status));
        result.residual = report.residual;
        result.message = step_failure(report, k, march->point().time, choice.options.mode);
        break;
      }
      result.steps = k;
      march->for_each_inner_stage(watch_stage);
      recorder.observe(reported(system, march->point()));
      progress.update(k);
      if (guard.interrupted() && k < steps) {
        result.status = interrupted_status;
        result.message = fmt::format("interrupted after step {} of {}; what was computed is kept", k, steps);
        break;
      }
    }
  }
  recorder.finish(result);
  if (const long count = march->without_root(); count > 0) {
    result.notes.push_back(without_root_note(count, result.steps, choice.options.without_root));
    result.ledger.entries.push_back(counted_entry("steps off the energy", count, result.steps));
  }
  result.ledger.mean_iterations = result.steps > 0 ? double(result.iterations) / double(result.steps) : 0;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// The same, to be run later: [time] steps, [solver] and [output] are read from the scene, which must hold no key
/// besides those read.
template <DiscreteSystem Sys>
Task<Sys> simulation(const Section& scene, const RunContext& context, const Sys& system,
                     const Presentation<Sys>& presentation, const State<typename Sys::GroupoidType>& initial,
                     const ArrowOf<typename Sys::GroupoidType>& configuration) {
  const long steps = read_time(scene).steps;
  const MarchChoice choice = read_march(scene, abilities_of<Sys>);
  const long every = read_every(scene, context);
  scene.finish();
  return {system, [=](const Observer<Sys>& observer) {
            return simulate(system, presentation, initial, configuration, steps, choice, every, context, observer);
          }};
}

}  // namespace lagroid::app
