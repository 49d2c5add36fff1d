#pragma once
/// What the curvature of a solution is, by the inertia of its KKT matrix: that of a strict local minimum, or that of a
/// saddle, from where the cost falls.
///
/// An interior point has z_i / s_i times the square of each inequality's derivative in the matrix: much where one acts,
/// and a little, mu / s_i^2, where it does not. Of a cost that is level along some direction, as where every motion
/// costs the same, that little alone would make a minimum. It therefore stands in the matrix with its sign turned: a
/// minimum that does not rest on it keeps its inertia, and vertices (bang-bang controls) keep pivots that are not zero.
/// What may act (z_i / s_i above a millionth) keeps its sign. A strict minimum is meant, what is open may be one all
/// the same: where controls curve the cost by way of later nodes alone, as along a car's straight line, pivots are too
/// small to tell.
///
/// At a saddle the matrix has more negative eigenvalues than equalities, though all of that stands in it as it is, and
/// 1e-8 of its largest second derivative besides.
///
///     if (curvature_of(kkt, derivatives, multipliers, slacks, sigma, dual) == Curvature::saddle) leave();
///
/// Requires multipliers z >= 0 and slacks s > 0 of a solution, and two workspaces, rows of gamma and of phi. Where
/// equalities repeat each other the inertia says nothing, and the answer is open. No allocation. Nothing throws.

#include <lagroid/solvers/control/stage_kkt.hpp>

namespace lagroid {

enum class Curvature {
  open,            ///< not to be told
  strict_minimum,  ///< a local one
  saddle           ///< the cost falls along a direction that the constraints allow
};

/// Leaves the matrix factored, at a saddle with z / s of the inequalities.
Curvature curvature_of(StageKkt& kkt, const StageDerivatives& derivatives, const StageRows& multipliers,
                       const StageRows& slacks, StageRows& sigma, StageRows& dual);

}  // namespace lagroid
