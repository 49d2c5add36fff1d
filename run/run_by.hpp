#pragma once
/// `run` by any of the methods that a scene can name. It compiles all of them that the system has: a minute.

#include <lagroid/run/run.hpp>
#include <lagroid/solvers/march_methods.hpp>

namespace lagroid {

/// As the other `run`, by the march that `how` asks for. Throws std::invalid_argument for what the system does not have
/// (make_march).
template <DiscreteSystem Sys>
RunResult run_by(const MarchOptions& how, const Sys& system, const State<typename Sys::GroupoidType>& start,
                 const RunOptions<Sys>& options = {}) {
  const auto configuration = options.configuration.value_or(system.groupoid.unit(start.object));
  return run<Sys>(system, make_march(system, start, configuration, how), how, options);
}

}  // namespace lagroid
