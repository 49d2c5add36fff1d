#pragma once
/// The time-dependent Bregman Hamiltonians, and the coefficients of their discrete flows:
///
///     r+ = r - beta(t) grad f(q) - dC^T lambda,    q+ = q + alpha(t) r+.
///
/// HamiltonianDescent (accelerated.hpp) takes its mu and s from them.
///
///     const optimisation::Coefficients now = optimisation::coefficients({.p = 6}, 0.1, 1e-3);  // t, h
///
/// `check` throws std::invalid_argument, with the remedy, for numbers out of range. [V] (5.2) to (5.5), (5.11), (5.12)

#include <optional>
#include <string>

namespace lagroid::optimisation {

/// Which Hamiltonian ([V] (5.2), (5.3); in a vector space (5.4), (5.5) are those with lambda = 1), r the momentum, t
/// the time as a coordinate:
///
///     direct     p / (2 t^(lambda p + 1)) |r|^2 + C p t^((lambda + 1) p - 1) f(q) + r_t
///     adaptive   p^2 / (2 po t^(lambda p + po/p)) |r|^2 + C p^2 / po t^((lambda + 1) p - po/p) f(q)
///                + p / po t^(1 - po/p) r_t
///
/// lambda = zeta for a geodesically convex f, zeta / alpha for an alpha-weakly quasi-convex one. Along their motions
/// f(q(t)) - f* is O(t^-p) on sets where f is so and geodesics are unique; on whole spheres and Stiefel manifolds no f
/// but a constant is convex, and the rate is one near the minimum.
struct Bregman {
  enum class Kind { direct, adaptive };
  Kind kind = Kind::adaptive;
  double p = 6;
  double po = 2;  ///< p-ring; of `adaptive` alone
  double c = 1;   ///< C > 0
  /// At least 1; without it zeta of the manifold, in a vector space 1. On Stiefel manifolds zeta grows like the square
  /// root of the number of columns: with many, lambda = 1 takes fewer iterations.
  std::optional<double> lambda = {};
};

/// Throws std::invalid_argument, with the remedy, for p, po, C <= 0 or lambda < 1.
void check(const Bregman& bregman);

/// One step of the type II map with r = 0 ([V] (5.11), (5.12)) is, with h the step,
///
///     r+ = r - beta grad f - dC^T multipliers,   q+ = q + alpha r+,   t+ = t + ...
///
/// alpha and beta at the time t, and the next time.
struct Coefficients {
  double alpha;
  double beta;
  double next_time;
};
Coefficients coefficients(const Bregman& bregman, double t, double h);

}  // namespace lagroid::optimisation
