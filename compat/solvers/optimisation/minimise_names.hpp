#pragma once
/// Names of version 0.2 that <lagroid/solvers/optimisation/minimise.hpp> had; this goes with version 0.4.

#include <lagroid/solvers/optimisation/minimise.hpp>

namespace lagroid::optimisation {

using Method [[deprecated("Method is DescentMethod")]] = DescentMethod;
using Outcome [[deprecated("Outcome is MinimisationStatus")]] = MinimisationStatus;
using State [[deprecated("State is EvaluatedPoint")]] = EvaluatedPoint;
using Step [[deprecated("Step is StepOutcome")]] = StepOutcome;

}  // namespace lagroid::optimisation
