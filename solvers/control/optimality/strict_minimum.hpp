#pragma once
/// Whether a solution is a strict local minimum, by the inertia of its KKT matrix.
///
/// An interior point has z_i / s_i times the square of each inequality's derivative in the matrix: much where one acts,
/// and a little, mu / s_i^2, where it does not. Of a cost that is level along some direction, as where every motion
/// costs the same, that little alone would make a minimum. It therefore stands in the matrix with its sign turned: a
/// minimum that does not rest on it keeps its inertia, and vertices (bang-bang controls) keep pivots that are not zero.
/// What may act (z_i / s_i above a millionth) keeps its sign. A yes is meant, a no is not always: where controls curve
/// the cost by way of later nodes alone, as along a car's straight line, pivots are too small to tell.
///
///     const bool strict = is_strict_minimum(kkt, derivatives, multipliers, slacks, sigma, dual);
///
/// Requires multipliers z >= 0 and slacks s > 0 of a solution, and two workspaces, rows of gamma and of phi. Where
/// equalities repeat each other the inertia says nothing, and the answer is no. No allocation. Nothing throws.

#include <lagroid/solvers/control/stage_kkt.hpp>

namespace lagroid {

/// Leaves the matrix factored.
bool is_strict_minimum(StageKkt& kkt, const StageDerivatives& derivatives, const StageRows& multipliers,
                       const StageRows& slacks, StageRows& sigma, StageRows& dual);

}  // namespace lagroid
