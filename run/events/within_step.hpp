#pragma once
/// Where a function of the share of a step, 0 to 1, passes zero or is smallest or largest.
///
///     const StepFunction g = [](double share) { return share * share - 0.25; };
///     const double at = root_within(g, 0, 1, -0.25, 0.75);
///     const double slope = slope_within(g, at);
///
/// Requires a function that is smooth over the step, as one made of partial steps; it is evaluated at shares from 0
/// to 1. What it throws goes through. (Alefeld, Potra and Shi, ACM Trans. Math. Softw. 21 (1995) 327, as in
/// Boost.Math.)

#include <functional>

namespace lagroid {

using StepFunction = std::function<double(double)>;

/// Between `a` and `b`, at which the function has the values `at_a` and `at_b` of opposite signs: of all shares at
/// which it was evaluated, that with the smallest value.
double root_within(const StepFunction& g, double a, double b, double at_a, double at_b);

/// The derivative at a share, by differences of order four: central ones and, near the ends, those inwards.
double slope_within(const StepFunction& g, double share);

}  // namespace lagroid
