#pragma once
/// A scene, read and checked, before anything is computed.

#include <lagroid/core/system.hpp>
#include <lagroid/run/drive.hpp>
#include <lagroid/run/motion.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/run/study/method.hpp>
#include <lagroid/run/system_node.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace lagroid::app {

/// An initial value of equal steps of order two by Newton, as ensembles march them (simulation.hpp).
template <DiscreteSystem Sys> struct PlainMarch;

template <DiscreteSystem Sys> struct Task {
  Sys system;
  std::function<RunResult(const Observer<Sys>&)> run;
  std::function<std::unique_ptr<Motion>()> begin;          ///< the motion alone; null for boundary values
  std::vector<Method> methods = {};                        ///< by which the scene could march
  std::shared_ptr<const PlainMarch<Sys>> plain = nullptr;  ///< null where it is no such march
};

}  // namespace lagroid::app
