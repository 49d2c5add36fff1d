#pragma once
/// Motions as a study integrates them: alone, without records, so that nothing but steps is timed.
///
///     IntegrationCost work;
///     const StepReport report = integrate_to(motion, 10.0, work);  // to the time 10 s

#include <lagroid/run/motion/motion.hpp>

#include <optional>
#include <vector>

namespace lagroid {

/// What an integrator has cost so far.
struct IntegrationCost {
  long steps = 0;
  long evaluations = 0;  ///< Motion::evaluations
};

/// What a study sees at a node, beside the state.
struct NodeObservation {
  std::vector<NamedVector> invariants;  ///< what the system keeps, conserved or bounded
  std::optional<double> constraint;     ///< Motion::defect
};

/// One step.
StepReport advance(Motion& motion, IntegrationCost& work);
/// Steps until the time `end` is less than half a step away, and looks at nothing. The report is that of the last step.
StepReport integrate_to(Motion& motion, double end, IntegrationCost& work);
/// The node that was reached.
NodeObservation observation_of(Motion& motion);

}  // namespace lagroid
