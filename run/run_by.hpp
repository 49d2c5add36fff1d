#pragma once
/// `run` by any of the methods that a scene can name.
///
///     const RunResult result = run_by({.mode = TimeMode::adaptive}, system, start, {.steps = 1000});
///
/// Requires patience once: it compiles all methods that the system has, a minute. Returns and throws as `run`, and
/// std::invalid_argument for a method that the system does not have.

#include <lagroid/run/run.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>

namespace lagroid {

/// As the other `run`, by the integrator that `how` specifies. Throws std::invalid_argument for what the system does
/// not have (make_integrator).
template <DiscreteSystem Sys>
RunResult run_by(const IntegratorOptions& how, const Sys& system, const State<typename Sys::GroupoidType>& start,
                 const RunOptions<Sys>& options = {}) {
  const auto configuration = options.configuration.value_or(system.groupoid.unit(start.object));
  return run<Sys>(system, make_integrator(system, start, configuration, how), how, options);
}

}  // namespace lagroid
