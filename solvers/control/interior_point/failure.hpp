#pragma once
/// What is said of a solve at its end, by whichever method: which constraints repeat each other, and where it did not
/// converge why, what to do, and what is violated most.
///
///     explain_end(transcription, values, derivatives, options, report);
///
/// Nothing throws.

#include <lagroid/solvers/control/interior_point.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// Why it ended and what to do, in a sentence; empty where it converged.
std::string advice_of(ControlStatus status, int max_iterations);

/// Of values and derivatives where the trajectory stands. A solve that failed where constraints repeat each other
/// becomes `redundant`: nothing is known of the rest.
void explain_end(const Transcription& transcription, const StageValues& values, const StageDerivatives& derivatives,
                 const ControlOptions& options, ControlReport& report);

/// The largest five of what is violated by more than the tolerance, the largest first.
std::vector<ConstraintViolation> worst_violations(const TranscriptionSizes& sizes, const StageValues& values,
                                                  double tolerance);

}  // namespace lagroid
