#pragma once
/// Motions as a study looks at them: marched alone, without records.

#include <lagroid/run/motion.hpp>

#include <optional>
#include <vector>

namespace lagroid {

/// What a march has cost so far.
struct Work {
  long steps = 0;
  long evaluations = 0;  ///< Motion::evaluations
};

/// What a study sees at a node, beside the state.
struct Sight {
  std::vector<NamedVector> invariants;  ///< what the system keeps, conserved or bounded
  std::optional<double> constraint;     ///< Motion::defect
};

/// One step.
StepReport advance(Motion& motion, Work& work);
/// Steps until `end` is less than half a step away, and looks at nothing. The report is that of the last step.
StepReport march_to(Motion& motion, double end, Work& work);
/// The node that was reached.
Sight sight_of(Motion& motion);

}  // namespace lagroid
