#pragma once
/// Hamilton's equations with holonomic constraints: the hidden constraint, and multipliers that it determines.

#include <lagroid/core/directional.hpp>
#include <lagroid/core/implicit.hpp>

#include <Eigen/LU>

namespace lagroid {

/// The velocity of the constraint, C'(q) H_p(q, p), of a system that writes, over any scalar,
///
///     static constexpr int dimension, constraints;
///     template <class S> S hamiltonian(const Vector<S, n>& q, const Vector<S, n>& p) const
///     template <class S> Vector<S, d> constraint(const Vector<S, n>& q) const               where d > 0
template <class M, class S, int N>
Vector<S, M::constraints> hidden_constraint(const M& system, const Vector<S, N>& q, const Vector<S, N>& p) {
  Vector<Dual<S>, N> fixed;
  for (int i = 0; i < N; ++i) fixed(i) = Dual<S>(q(i));
  const Vector<S, N> velocity =
      gradient_of([&](const Vector<Dual<S>, N>& x) { return system.hamiltonian(fixed, x); }, p);
  return derivative_along([&](const Vector<Dual<S>, N>& x) { return system.constraint(x); }, q, velocity);
}

/// p + <nu, C'(q)> with nu such that it is tangent to C^{-1}(0): <H_p, C'(q)> = 0 ([V] Remark 3.2; RATTLE's second
/// stage). By Newton's method from p; not a number where that fails. p itself where there is no constraint.
template <class M, int N>
Vector<double, N> project_momentum(const M& system, const Vector<double, N>& q, const Vector<double, N>& p) {
  constexpr int d = M::constraints;
  if constexpr (d == 0) {
    return p;
  } else {
    const auto normal = [&]<class S>(const Vector<S, N>& x, const Vector<S, d>& nu) -> Vector<S, N> {
      return jacobian_of<d>([&](const Vector<Dual<S>, N>& y) { return system.constraint(y); }, x).transpose() * nu;
    };
    const auto residual = [&]<class S>(const Vector<S, d>& nu, const Vector<S, 2 * N>& qp) -> Vector<S, d> {
      const Vector<S, N> x = qp.template head<N>();
      return hidden_constraint(system, x, Vector<S, N>(qp.template tail<N>() + normal(x, nu)));
    };
    const Vector<double, d> nu = solve_implicit<double, d, 2 * N>(residual, Vector<double, d>::Zero(), joined(q, p));
    return p + normal(q, nu);
  }
}

/// q' = H_p, p' = -H_q + <lambda, C'(q)>.
template <class S, int N, int D> struct HamiltonianRates {
  Vector<S, N> q;
  Vector<S, N> p;
  Vector<S, D> multipliers;
};

/// The rates at (q, p), lambda such that the hidden constraint stays constant: with G = <H_p, C'> it solves
/// {G, H} + <lambda, G_p C'> = 0. Requires a regular G_p C', at most 4 constraints. The sign of lambda is that of
/// docs/notation.md; [V] (3.6) has the other.
template <class M, class S, int N>
HamiltonianRates<S, N, M::constraints> hamiltonian_rates(const M& system, const Vector<S, N>& q,
                                                         const Vector<S, N>& p) {
  constexpr int d = M::constraints;
  static_assert(d <= 4, "the small system for lambda is solved by cofactors");
  const Vector<S, 2 * N> z = joined(q, p);
  const Vector<S, 2 * N> slope = gradient_of(
      [&](const Vector<Dual<S>, 2 * N>& x) {
        return system.hamiltonian(Vector<Dual<S>, N>(x.template head<N>()), Vector<Dual<S>, N>(x.template tail<N>()));
      },
      z);
  HamiltonianRates<S, N, d> out{slope.template tail<N>(), -slope.template head<N>(), {}};
  if constexpr (d > 0) {
    const Matrix<S, d, N> normals =
        jacobian_of<d>([&](const Vector<Dual<S>, N>& x) { return system.constraint(x); }, q);
    const auto hidden_along = [&](const Vector<S, N>& dq, const Vector<S, N>& dp) {
      return derivative_along(
          [&](const Vector<Dual<S>, 2 * N>& x) {
            return hidden_constraint(system, Vector<Dual<S>, N>(x.template head<N>()),
                                     Vector<Dual<S>, N>(x.template tail<N>()));
          },
          z, joined(dq, dp));
    };
    const Vector<S, d> free = hidden_along(out.q, out.p);
    Matrix<S, d, d> matrix;
    Vector<S, N> rest;
    for (int i = 0; i < N; ++i) rest(i) = S(0.0);
    for (int j = 0; j < d; ++j) matrix.col(j) = hidden_along(rest, Vector<S, N>(normals.row(j).transpose()));
    if constexpr (d == 1) {
      out.multipliers(0) = -free(0) / matrix(0, 0);
    } else {
      out.multipliers = -(matrix.inverse() * free);
    }
    out.p += normals.transpose() * out.multipliers;
  }
  return out;
}

}  // namespace lagroid
