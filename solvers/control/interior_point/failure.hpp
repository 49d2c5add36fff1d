#pragma once
/// What is said of a solve that did not converge, by whichever method.
///
///     report.message = advice_of(report.status, options.max_iterations);
///     report.worst = worst_violations(sizes, values, options.tolerance);
///
/// Nothing throws.

#include <lagroid/solvers/control/interior_point.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// Why it ended and what to do, in a sentence; empty where it converged.
std::string advice_of(ControlStatus status, int max_iterations);

/// The largest five of what is violated by more than the tolerance, the largest first.
std::vector<ConstraintViolation> worst_violations(const TranscriptionSizes& sizes, const StageValues& values,
                                                  double tolerance);

}  // namespace lagroid
