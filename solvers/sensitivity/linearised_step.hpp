#pragma once
/// The step equations and the state at a step's end, with their derivatives along everything that they depend on:
///
///     E = (-df/dv - mu, phi(g), C(beta(g))),    F+ = df/dw,    at tau(v)^{-1} g tau(w), lambda, theta.
///
/// The gradients of the step are evaluated over numbers with derivatives (core/scalars/varied.hpp), so that forces,
/// reactions, constraints and parameters need no formula of their own.
///
///     LinearStep out(Sys::dimension + Sys::constraints, 2 * Sys::dimension, int(members.size()));
///     linearise_step(system, step, members, out);
///
/// Requires functions of the system that are templates on the scalar, and members of this very system, which
/// lagrangian, constraints and forces read by `varied`. Errors: an `annihilator` for doubles alone does not compile.
/// [G] Def. 3.3

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>

#include <algorithm>
#include <span>

namespace lagroid {

/// The gradients at a step along v, w, lambda and the members, in this order: put(direction, d_source, d_target,
/// d_constraint).
template <DiscreteSystem Sys, class Put>
void differentiate_gradients(const Sys& system, const Step<Sys>& step, std::span<const double* const> members,
                             const Put& put) {
  constexpr int n = Sys::dimension;
  constexpr int m = Sys::constraints;
  using V = VariedNumber;
  const int count = 2 * n + m + int(members.size());
  const Vector<double, n> zero = Vector<double, n>::Zero();
  const auto arrow = system.groupoid.template cast<V>(step.arrow);
  detail::for_directions(count, [&](int first) {
    const VariedMembers varying(members, 2 * n + m - first);
    const Vector<V, n> v = detail::varied_along(zero, -first);
    const Vector<V, n> w = detail::varied_along(zero, n - first);
    const Vector<V, m> lambda = detail::varied_along(step.multipliers, 2 * n - first);
    const GradientsOf<Sys, V> at = automatic_gradients<Sys, V>(system, system.groupoid.translate(v, arrow, w), lambda);
    for (int k = first; k < std::min(count, first + varied_at_once); ++k) {
      Vector<double, n> source;
      Vector<double, n> target;
      Vector<double, m> constraint;
      for (int i = 0; i < n; ++i) {
        source(i) = at.source_gradient(i).tangent(k - first);
        target(i) = at.target_gradient(i).tangent(k - first);
      }
      for (int a = 0; a < m; ++a) constraint(a) = at.constraint(a).tangent(k - first);
      put(k, source, target, constraint);
    }
  });
}

/// The step, linearised at its solution: x = (v, mu, theta), z = (w, lambda). The end's momentum is taken as
/// mu + (F+ - F-)(g, lambda), in which the large terms of both gradients, m (q1 - q0) / h, are gone.
template <DiscreteSystem Sys>
void linearise_step(const Sys& system, const Step<Sys>& step, std::span<const double* const> members, LinearStep& out) {
  constexpr int n = Sys::dimension;
  constexpr int m = Sys::constraints;
  using V = Vector<double, n>;
  out.equations_by_start.setZero();
  out.end_by_start.setZero();
  out.end_by_unknowns.setZero();
  for (int i = 0; i < n; ++i) {
    out.equations_by_start(i, n + i) = -1;
    out.end_by_unknowns(i, i) = 1;
    out.end_by_start(n + i, n + i) = 1;
  }
  const auto put = [&](int k, const V& source, const V& target, const Vector<double, m>& constraint) {
    const bool unknown = n <= k && k < 2 * n + m;
    auto& equations = unknown ? out.equations_by_unknowns : out.equations_by_start;
    auto& end = unknown ? out.end_by_unknowns : out.end_by_start;
    // v, then the momentum; w and lambda; what is left of x are the members.
    const int column = unknown ? k - n : k < n ? k : k - m;
    for (int i = 0; i < n; ++i) {
      equations(i, column) = -source(i);
      end(n + i, column) = source(i) + target(i);
    }
    for (int a = 0; a < m; ++a) equations(n + a, column) = constraint(a);
  };
  differentiate_gradients(system, step, members, put);
}

}  // namespace lagroid
