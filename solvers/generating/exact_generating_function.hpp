#pragma once
/// The exact generating functions of constrained Hamilton's equations: the action along the solution,
///
///     L_d^E(q0, q1) = int_0^h (p.q' - H) dt,    H_d+ = p1.q1 - L_d^E,    H_d- = -p0.q0 - L_d^E,
///
/// with its first derivatives p0 and p1. Orders of discrete ones are measured against them. Requires a start that
/// satisfies the constraint and the hidden one; not a number where the solution ends before the time. [V] (2.7),
/// (3.10), (3.12)

#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/core/scalars/series.hpp>
#include <lagroid/solvers/generating/hidden_constraint.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

/// A solution from (q0, p0) to (q1, p1) and its action, the integral of p.q' - H.
template <class S, int N> struct ExactArc {
  Vector<S, N> q0;
  Vector<S, N> p0;
  Vector<S, N> q1;
  Vector<S, N> p1;
  S action;

  /// The exact generating function where it is a function: of (q0, q1), of (q0, p1) or of (q1, p0) ([V] (2.7), (3.10),
  /// (3.12); without constraints L_d^E, (3.1), (3.3)).
  S generating(GeneratingType type) const {
    switch (type) {
      case GeneratingType::two:
        return p1.dot(q1) - action;
      case GeneratingType::three:
        return -p0.dot(q0) - action;
      case GeneratingType::one:
        break;
    }
    return action;
  }
};

/// The solution of Hamilton's constrained equations ([V] (3.6)) for the time t, of either sign, by Taylor's method of
/// order 19 with multipliers eliminated (`hamiltonian_rates`) and steps that leave no more than round-off. (q0, p0)
/// must satisfy the constraint and the hidden one. Not a number where the solution ends before t.
template <class M, class S, int N>
ExactArc<S, N> exact_arc(const M& system, const Vector<S, N>& q0, const Vector<S, N>& p0, double t) {
  constexpr int terms = 20;
  constexpr double epsilon = std::numeric_limits<double>::epsilon() / 16;
  using T = Series<S, terms>;
  const auto rates = [&](const Vector<T, 2 * N + 1>& z) {
    const Vector<T, N> q = part<0, N>(z);
    const Vector<T, N> p = part<N, N>(z);
    const auto r = hamiltonian_rates(system, q, p);
    Vector<T, 1> action;
    action(0) = p.dot(r.q) - system.hamiltonian(q, p);
    return joined(joined(r.q, r.p), action);
  };
  Vector<S, 1> none;
  none(0) = S(0.0);
  Vector<S, 2 * N + 1> z = joined(joined(q0, p0), none);
  for (double left = t; left != 0 && !std::isnan(left);) {
    const auto series = taylor_solution<terms>(rates, z);
    // The last two coefficients bound what is left out.
    double step = std::abs(left);
    for (int k = terms - 2; k < terms; ++k) {
      double largest = 0;
      double size = 1;
      for (int i = 0; i <= 2 * N; ++i) {
        largest = std::max(largest, std::abs(double(value_of(series(i)[k]))));
        size = std::max(size, std::abs(double(value_of(series(i)[0]))));
      }
      if (largest > 0) step = std::min(step, 0.7 * std::pow(epsilon * size / largest, 1.0 / k));
    }
    if (!(step > 1e-9 * std::abs(t))) step = std::numeric_limits<double>::quiet_NaN();
    const double signed_step = std::abs(left) <= step ? left : std::copysign(step, left);
    for (int i = 0; i <= 2 * N; ++i) z(i) = series(i).at(signed_step);
    left -= signed_step;
  }
  return {q0, p0, part<0, N>(z), part<N, N>(z), z(2 * N)};
}

}  // namespace lagroid
