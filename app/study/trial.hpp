#pragma once
/// A scene's motion as a study looks at it: marched alone, without records.

#include <lagroid/solvers/method.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

/// What a march has cost so far. Evaluations are those of the method (MethodTraits::stages), or the solver's
/// iterations.
struct Work {
  long steps = 0;
  long evaluations = 0;
};

/// Some numbers at a node that are compared as one vector.
struct Block {
  std::string name;
  std::vector<double> values;
  double size = 0;  ///< of the terms that they are made of, to which an error is relative; 0: their own
};

/// What is seen at a node.
struct Sight {
  std::vector<Block> state;       ///< configuration and momentum, in coordinates
  std::vector<Block> invariants;  ///< what the system keeps, conserved or bounded
  double constraint = 0;          ///< the largest residual of constraints, and of the groupoid's own equations
  bool constrained = false;       ///< whether there are any
};

class Trial {
 public:
  virtual ~Trial() = default;
  virtual StepReport advance(Work& work) = 0;
  /// Steps until `end` is less than half a step away, and looks at nothing. The report is that of the last step.
  virtual StepReport run(double end, Work& work) = 0;
  virtual double time() const = 0;
  /// The node that was reached.
  virtual Sight see() = 0;
  virtual MethodTraits traits() const = 0;
};

/// A way to march a scene: what stands in its [time], as "key=value".
struct Method {
  std::string name;
  int order = 2;
  int stages = 1;  ///< steps of order two that it is made of, so that first steps of methods cost about the same
  bool equal_steps = true;
  std::vector<std::string> settings;
  bool to_compare = false;  ///< there to be compared with, and not chosen for anyone
};

/// Counts a step of a march with these traits.
inline void count(Work& work, const StepReport& report, int stages) {
  ++work.steps;
  work.evaluations += stages > 0 ? stages : report.iterations;
}

}  // namespace lagroid::app
