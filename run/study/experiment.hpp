#pragma once
/// A motion to be integrated by many methods with many steps: how it begins for each, when it ends, and which methods
/// apply.
///
///     const std::unique_ptr<Motion> motion = experiment.begin(experiment.methods.front(), experiment.step);
///
/// Errors: MethodRefused where a method does not take the step.

#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/study/method.hpp>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// A method that does not take this step; the message has the reason.
class MethodRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Experiment {
  std::string name;             ///< of the system or the scene
  double end = 0;               ///< the time that the motion lasts, s
  double step = 0;              ///< its own step
  std::vector<Method> methods;  ///< all that apply
  /// The motion from its start, by that method and that step, to last until `end`. May be called by several threads at
  /// once. Throws MethodRefused.
  std::function<std::unique_ptr<Motion>(const Method& method, double h, double end)> motion;
  std::function<bool()> interrupted = nullptr;  ///< called now and then; null: never interrupted

  bool stopped() const { return interrupted && interrupted(); }
  std::unique_ptr<Motion> begin(const Method& method, double h) const { return motion(method, h, end); }
};

}  // namespace lagroid
