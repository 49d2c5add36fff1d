#pragma once
/// Where a function of the share of a step, 0 to 1, passes zero or is smallest or largest.
///
///     const StepFunction g = [](double share) { return share * share - 0.25; };
///     const double at = root_within(g, 0, 1, -0.25, 0.75).share;
///     const double slope = slope_within(g, at);
///
/// Requires a function that is smooth over the step but for jumps, poles and kinks, as one made of partial steps; it is
/// evaluated at shares from 0 to 1. Errors: NoNumber where it is no finite number there; what it throws goes through.
/// (Alefeld, Potra and Shi, ACM Trans. Math. Softw. 21 (1995) 327, as in Boost.Math.)

#include <functional>

namespace lagroid {

using StepFunction = std::function<double(double)>;

/// A function was no finite number at a share at which it was needed.
struct NoNumber {
  double share;
};

struct RootInStep {
  double share;
  bool is_jump;  ///< the sign changes there, but the function is not zero: it jumps, or has a pole
};

/// Between `a` and `b`, at which the function has the values `at_a` and `at_b` of opposite signs: the end of the last
/// bracket, of two neighbouring numbers, at which it is smaller.
RootInStep root_within(const StepFunction& g, double a, double b, double at_a, double at_b);

/// By how much a slope within a step is more rounded than its function: of central differences.
inline constexpr double slope_rounding = 384;

/// The derivative at a share, by differences of order four: central ones and, near the ends, those inwards.
double slope_within(const StepFunction& g, double share);

/// Where the function is smallest or largest, from the slopes of opposite signs at the ends of the step; of a function
/// with a kink, at it.
double turn_within(const StepFunction& g, double slope_at_0, double slope_at_1);

/// Whether what bends the function over the step is rounding, which no share of the step smooths.
bool is_rounding_within(const StepFunction& g);

}  // namespace lagroid
