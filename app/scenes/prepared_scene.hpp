#pragma once
/// A scene, read and checked, before anything is computed.
///
///     const RunResult result = prepared.run(nullptr);            // the whole of it
///     const std::unique_ptr<Motion> motion = prepared.begin();  // the motion alone, of an initial value

#include <lagroid/core/system.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/motion/system_node.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/run/study/method.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

/// An initial value as gradients and ensembles take it (simulation.hpp).
template <DiscreteSystem Sys> struct StatedInitialValue;

template <DiscreteSystem Sys> struct PreparedScene {
  Sys system;
  std::function<RunResult(const Observer<Sys>&)> run;
  std::function<std::unique_ptr<Motion>()> begin;                   ///< the motion alone; null for boundary values
  std::vector<Method> methods = {};                                 ///< by which the scene could be integrated
  std::shared_ptr<const StatedInitialValue<Sys>> stated = nullptr;  ///< null where it is none
  std::string reduced_by = {};                                      ///< the reduction that it names, or none
};

}  // namespace lagroid::app
