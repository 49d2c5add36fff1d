#pragma once
/// Hamilton's equations with holonomic constraints, the hidden constraint, and the multipliers that it determines:
///
///     q' = H_p,    p' = -H_q + <lambda, C'(q)>,    C(q) = 0,    C'(q) H_p(q, p) = 0.
///
/// A momentum belongs to a motion on C^{-1}(0) only where it satisfies the hidden constraint; `project_momentum` makes
/// it so, and `hamiltonian_rates` is the right-hand side for any method of differential equations.
///
///     struct Rod {
///       static constexpr int dimension = 2, constraints = 1;
///       template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
///         return p.squaredNorm() * 0.5 + q(1);
///       }
///       template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
///         return Vector<S, 1>(q.squaredNorm() - 1.0);
///       }
///     };
///     inline Vector<double, 2> tangent() { return project_momentum<Rod, 2>({}, {0, -1}, {1, 1}); }  // (1, 0)
///
/// Requires a regular G_p C' (G the hidden constraint); not a number where it is not. [V] (3.6), with the other sign of
/// lambda, and Remark 3.2

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/implicit.hpp>

#include <Eigen/LU>

namespace lagroid {

/// The velocity of the constraint, C'(q) H_p(q, p), of a system that writes, over any scalar,
///
///     static constexpr int dimension, constraints;
///     template <class S> S hamiltonian(const Vector<S, n>& q, const Vector<S, n>& p) const
///     template <class S> Vector<S, d> constraint(const Vector<S, n>& q) const               where d > 0
template <class M, class S, int N>
Vector<S, M::constraints> hidden_constraint(const M& system, const Vector<S, N>& q, const Vector<S, N>& p) {
  const auto fixed = constants<Dual<S>>(q);
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
    const auto kicked = [&]<class S>(const Vector<S, N>& x, Vector<S, N> y, const Vector<S, d>& nu) {
      const auto normals = jacobian_of<d>([&](const Vector<Dual<S>, N>& z) { return system.constraint(z); }, x);
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < d; ++j) y(i) += normals(j, i) * nu(j);
      return y;
    };
    const auto residual = [&]<class S>(const Vector<S, d>& nu, const Vector<S, 2 * N>& qp) -> Vector<S, d> {
      const Vector<S, N> x = part<0, N>(qp);
      return hidden_constraint(system, x, kicked(x, part<N, N>(qp), nu));
    };
    const Vector<double, d> nu = solve_implicit<double, d, 2 * N>(residual, Vector<double, d>::Zero(), joined(q, p));
    return kicked(q, p, nu);
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
  const Vector<S, 2 * N> slope =
      gradient_of([&](const Vector<Dual<S>, 2 * N>& x) { return system.hamiltonian(part<0, N>(x), part<N, N>(x)); }, z);
  HamiltonianRates<S, N, d> out{part<N, N>(slope), {}, {}};
  for (int i = 0; i < N; ++i) out.p(i) = -slope(i);
  if constexpr (d > 0) {
    const Matrix<S, d, N> normals =
        jacobian_of<d>([&](const Vector<Dual<S>, N>& x) { return system.constraint(x); }, q);
    const auto hidden_along = [&](const Vector<S, N>& dq, const Vector<S, N>& dp) {
      return derivative_along(
          [&](const Vector<Dual<S>, 2 * N>& x) { return hidden_constraint(system, part<0, N>(x), part<N, N>(x)); }, z,
          joined(dq, dp));
    };
    const Vector<S, d> free = hidden_along(out.q, out.p);
    Matrix<S, d, d> matrix;
    Vector<S, N> rest;
    for (int i = 0; i < N; ++i) rest(i) = S(0.0);
    for (int j = 0; j < d; ++j) {
      Vector<S, N> normal;
      for (int i = 0; i < N; ++i) normal(i) = normals(j, i);
      const Vector<S, d> column = hidden_along(rest, normal);
      for (int i = 0; i < d; ++i) matrix(i, j) = column(i);
    }
    if constexpr (d == 1) {
      out.multipliers(0) = -free(0) / matrix(0, 0);
    } else {
      out.multipliers = -(matrix.inverse() * free);
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < d; ++j) out.p(i) += normals(j, i) * out.multipliers(j);
  }
  return out;
}

}  // namespace lagroid
