#pragma once
/// An estimate of the Lipschitz constant L of the Riemannian gradient, from which methods take their step sizes, as c /
/// L.

#include <lagroid/solvers/optimisation/minimise.hpp>

namespace lagroid::optimisation {

/// The largest |eigenvalue| of the Riemannian Hessian at the state, from below: by power steps from the gradient until
/// one adds less than a thousandth, `steps` of them at most.
double largest_curvature(Problem& problem, const EvaluatedPoint& state, int steps);

/// L, a Lipschitz constant of the Riemannian gradient: the one that the objective declares, else an estimate at the
/// state by `largest_curvature`, which costs a few Hessians times vectors.
double lipschitz_bound(Problem& problem, const EvaluatedPoint& state);

}  // namespace lagroid::optimisation
