#pragma once
/// Constraints that say what others say: row r of phi at a stage, whose derivative is a combination of those of rows
/// before it at that stage, and whose value is the same combination,
///
///     dphi_r = sum_j c_j dphi_j,    phi_r = sum_j c_j phi_j,
///
/// so that nothing contradicts. One whose value is another contradicts them: that is infeasible, and is not listed. A
/// condition on a node stands at the stage where it ends, beside all others on that node.
///
///     for (const RepeatedConstraint& each : repeated_constraints(transcription, values, derivatives, 1e-10))
///       fmt::print("row {} of stage {} repeats row {}\n", each.row, each.stage, each.of.front());
///
/// Requires values and derivatives of the trajectory where it stands. What is not linear is found out where it nearly
/// holds, for elsewhere its values are no such combination. Nothing throws.

#include <lagroid/solvers/control/transcription.hpp>

#include <vector>

namespace lagroid {

struct RepeatedConstraint {
  long stage = 0;
  int row = 0;
  std::vector<int> of = {};  ///< rows of that stage that it follows from; none: nothing that is free changes it
  long stages = 1;           ///< in so many one after another
};

/// Values are told apart to `tolerance`.
std::vector<RepeatedConstraint> repeated_constraints(const Transcription& transcription, const StageValues& values,
                                                     const StageDerivatives& derivatives, double tolerance);

}  // namespace lagroid
