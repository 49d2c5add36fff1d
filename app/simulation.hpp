#pragma once
/// Initial-value runs of any system.

#include "progress.hpp"
#include "recorder.hpp"
#include "scene_reader.hpp"
#include "task.hpp"

#include <lagroid/solvers/integrator.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace lagroid::app {

/// [time]: two of step, steps, duration.
struct TimeGrid {
  double step = 0;
  long steps = 0;
};
TimeGrid read_time(const Section& scene);

/// [solver] of an initial-value run.
struct StepperChoice {
  StepMethod method = StepMethod::newton;
  StepOptions options;
};
StepperChoice read_stepper(const Section& solver);

/// [output]: every n-th node is recorded (and the last); 0 when nothing is.
long read_every(const Section& scene, const RunContext& context);

/// What to say of a step that failed.
std::string step_failure(const StepReport& report, long step, double time);

/// The point with its momentum made tangent to the object constraints, as it is reported.
template <DiscreteSystem Sys> TrajectoryPoint<Sys> reported(const Sys& system, TrajectoryPoint<Sys> point) {
  point.state.momentum = tangent_momentum(system, point.state);
  return point;
}

/// Runs the system; a step that fails ends the run with what was computed so far.
template <DiscreteSystem Sys>
RunResult simulate(const Sys& system, const Presentation<Sys>& presentation,
                   const State<typename Sys::GroupoidType>& initial,
                   const ArrowOf<typename Sys::GroupoidType>& configuration, long steps, const StepperChoice& choice,
                   long every, const RunContext& context, const Observer<Sys>& observer) {
  const auto start = std::chrono::steady_clock::now();
  RunResult result;
  result.steps_asked = steps;
  Recorder<Sys> recorder(system, presentation, every, observer);
  Integrator<Sys> integrator(system, initial, configuration, make_step_solver(system, choice.method, choice.options));
  recorder.observe(reported(system, integrator.point()));
  {
    Progress progress(presentation.name, steps, context.progress);
    for (long k = 1; k <= steps; ++k) {
      const StepReport report = integrator.advance();
      result.iterations += report.iterations;
      result.ledger.most_iterations = std::max(result.ledger.most_iterations, report.iterations);
      if (!report.converged()) {
        result.status = std::string(to_string(report.status));
        result.residual = report.residual;
        result.message = step_failure(report, k, integrator.point().time);
        break;
      }
      result.steps = k;
      recorder.observe(reported(system, integrator.point()));
      progress.update(k);
    }
  }
  recorder.finish(result);
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
  const StepperChoice choice = read_stepper(scene.section_or_empty("solver"));
  const long every = read_every(scene, context);
  scene.finish();
  return {system, [=](const Observer<Sys>& observer) {
            return simulate(system, presentation, initial, configuration, steps, choice, every, context, observer);
          }};
}

}  // namespace lagroid::app
