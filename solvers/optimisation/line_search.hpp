#pragma once
/// How far to go along a direction of descent d: a step t with
///
///     f(R_x(t d)) <= f(x) + c t <grad f, d>        (Armijo),
///
/// and by secants one that is nearly lowest. Details of the methods; both return 0 where no step is found. Require
/// <grad f, d> < 0, given as `slope`, and d tangent at the state.

#include <lagroid/solvers/optimisation/minimise.hpp>

namespace lagroid::optimisation {

/// The step t, from `first` down, for which f(R_x(t d)) <= f(x) + decrease t slope, with `to` there; each next one is
/// where the parabola through f(x), the slope and the last value is lowest, between a tenth and a half of the last.
/// Near the minimum, where values differ by rounding only, a value that is no greater than f(x) by more than that is
/// enough. 0 where none is found. `buffer` is overwritten.
double backtrack(Problem& problem, ManifoldRetraction retraction, const EvaluatedPoint& state, const Vector& direction,
                 double slope, double first, double decrease, Point& to, Vector& buffer);

/// The step t for which f(R_x(t d)) <= f(x) + 1e-4 t slope, as above near the minimum, and the slope there, of which d
/// itself (of manifolds with a metric of their own, d transported) stands for the curve's direction, is at most `flat`
/// times the one at x: by secants from `first`, between bounds once there are two. Where that slope is not met in a few
/// trials, for d stands for the curve's direction near x only, the lowest of them. `to` is evaluated there. 0 where
/// none falls.
double secant_search(Problem& problem, ManifoldRetraction retraction, const EvaluatedPoint& state,
                     const Vector& direction, double slope, double first, double flat, EvaluatedPoint& to,
                     Vector& buffer);

}  // namespace lagroid::optimisation
