#pragma once
/// A control loop in the numbers of its scene, and the simulation that closes it: the problem is solved anew at every
/// sample, from where the last control has led and chance has pushed.
///
///     const auto loop = problem.loop(scene, watch);
///     const ControlResult found = close_loop(problem, *loop, scene_of_loop, start, watch);

#include "control_problem.hpp"

#include <lagroid/solvers/control/latency.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lagroid::app {

class SceneLoop {
 public:
  virtual ~SceneLoop() = default;
  /// Of the first plan, the cheapest that was found, or of the last sample.
  virtual const ControlReport& report() const = 0;
  /// A sample later, at this state: a new plan, from nothing where going on from the last one leads to none.
  virtual void advance(std::span<const double> state) = 0;
  virtual std::vector<double> control() const = 0;    ///< to be applied until the next sample
  virtual double cost() const = 0;                    ///< of the first stage of the plan
  virtual std::vector<double> predicted() const = 0;  ///< the state at the next sample, by the plan
  virtual double step() const = 0;                    ///< from a sample to the next
  virtual long stages() const = 0;                    ///< that the plan looks ahead
  virtual long restarts() const = 0;                  ///< samples that were planned from nothing
  virtual const Latency& latency() const = 0;         ///< of whole samples
};

/// [loop] of a scene.
struct LoopScene {
  long samples = 0;
  double disturbance = 0;  ///< standard deviation of what chance adds to each number of a state, at each sample
  std::uint64_t seed = 1;
  int iterations = 20;
  double tolerance = 1e-8;
  double usable = 1e-3;  ///< a plan that did not converge is followed where its constraints are violated by no more
};

/// The closed loop: states and controls sample by sample. It ends early where a plan is not usable, with its status.
ControlResult close_loop(const ControlProblem& problem, SceneLoop& loop, const LoopScene& scene,
                         std::vector<double> start, const std::function<bool(int)>& keep_going);

}  // namespace lagroid::app
