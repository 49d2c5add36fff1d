#pragma once
/// What an inequality gamma <= 0 adds to the Hessian of a solution, z / -gamma times dgamma^T dgamma: without bound
/// where it acts (z > 0 = gamma), nothing where it does not (z = 0 > gamma). Of a solution that is not exact, what is
/// left of z there must not be taken for curvature.
///
///     sigma[k][i] = acting_curvature(multipliers[k][i], slacks[k][i]);
///
/// Requires a positive slack, -gamma or the variable in its place. Nothing throws.

namespace lagroid {

inline double acting_curvature(double multiplier, double slack) { return multiplier > slack ? multiplier / slack : 0; }

}  // namespace lagroid
