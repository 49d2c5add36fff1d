#pragma once
/// Hamiltonian Taylor variational integrators: generating functions of type II from a continuous Hamiltonian H(q, p),
/// by Taylor's method of order r along the motion and a quadrature.
///
///     H_d+(q0, p1) = p1.q~1 - h sum b_i (p_i.H_p(q_i, p_i) - H(q_i, p_i))
///
/// They are made from H itself, where there is no Lagrangian or none is wanted. Their order is min(r + 1, that of the
/// quadrature) without constraints, and at most two with them.
///
///     struct Spring {
///       static constexpr int dimension = 1, constraints = 0;
///       template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
///         return (p(0) * p(0) + q(0) * q(0)) * 0.5;
///       }
///     };
///     inline const HamiltonianMap symplectic_euler(TaylorHamiltonian<Spring, 0>{});  // hamiltonian_map.hpp
///
/// Requires H over any scalar. Not a number where the initial momentum is not found from p1. [V] 5.4.1, Theorem 5.1

#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/core/hamiltonian/quadrature_rule.hpp>
#include <lagroid/core/scalars/series.hpp>

namespace lagroid {

/// The discrete right Hamiltonian of a Hamiltonian Taylor variational integrator ([V] 5.4.1), of type II; for type III
/// take its adjoint, H_d-(q1, p0; h) = -H_d+(q1, p0; -h). With Psi^(r)_t the Taylor method of order r of Hamilton's
/// equations, without constraints:
///
///     p1 = p of Psi^(r)_h(q0, p~)                   determines p~
///     (q_i, p_i) = Psi^(r)_{c_i h}(q0, p~)          at the nodes c_i of a quadrature with weights b_i
///     q~1 = q of Psi^(r+1)_h(q0, p~)
///     H_d+ = p1.q~1 - h sum b_i (p_i.H_p(q_i, p_i) - H(q_i, p_i))
///
/// For r = 0 it is p1.q0 + h H(q0, p1), whatever the quadrature. Without constraints the map has order min(r + 1, s),
/// s the quadrature's (Theorem 5.1); with constraints no more than two (docs/hamiltonian_maps.md). The system writes
///
///     static constexpr int dimension, constraints;
///     template <class S> S hamiltonian(const Vector<S, n>& q, const Vector<S, n>& p) const
///
/// over any scalar, from which the Taylor coefficients follow. Not a number where p~ is not found from p1.
template <class M, int R> struct TaylorHamiltonian {
  static_assert(R >= 0);
  static constexpr int dimension = M::dimension;
  static constexpr int constraints = M::constraints;
  static constexpr int n = dimension;
  static constexpr GeneratingType type = GeneratingType::two;
  M system;
  QuadratureRule rule = quadrature_rules::trapezoid;

  template <class S> S generating(const Vector<S, n>& q0, const Vector<S, n>& p1, double h) const {
    const auto flow = flow_from<R + 2>(q0, initial_momentum(q0, p1, h));
    S sum(0.0);
    for (int i = 0; i < n; ++i) sum += p1(i) * flow(i).at(h);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      Vector<S, 2 * n> z;
      for (int j = 0; j < 2 * n; ++j) z(j) = flow(j).at(rule.nodes[i] * h, R + 1);
      const Vector<S, n> q = part<0, n>(z);
      const Vector<S, n> p = part<n, n>(z);
      // p.H_p is the derivative along p.
      const auto fixed = constants<Dual<S>>(q);
      const S legendre =
          derivative_along([&](const Vector<Dual<S>, n>& x) { return system.hamiltonian(fixed, x); }, p, p);
      sum -= (legendre - system.hamiltonian(q, p)) * (h * rule.weights[i]);
    }
    return sum;
  }
  template <class S, int N> auto constraint(const Vector<S, N>& q) const { return system.constraint(q); }

 private:
  /// The Taylor coefficients of (q, p), up to t^{K-1}.
  template <int K, class S> Vector<Series<S, K>, 2 * n> flow_from(const Vector<S, n>& q, const Vector<S, n>& p) const {
    using T = Series<S, K>;
    return taylor_solution<K>(
        [this](const Vector<T, 2 * n>& z) {
          const Vector<T, 2 * n> slope = gradient_of(
              [this](const Vector<Dual<T>, 2 * n>& x) { return system.hamiltonian(part<0, n>(x), part<n, n>(x)); }, z);
          Vector<T, 2 * n> rate;
          for (int i = 0; i < n; ++i) {
            rate(i) = slope(n + i);
            rate(n + i) = -slope(i);
          }
          return rate;
        },
        joined(q, p));
  }

  template <class S> Vector<S, n> initial_momentum(const Vector<S, n>& q0, const Vector<S, n>& p1, double h) const {
    if constexpr (R == 0) {
      return p1;
    } else {
      const auto residual = [&]<class U>(const Vector<U, n>& p, const Vector<U, 2 * n>& given) -> Vector<U, n> {
        const auto flow = flow_from<R + 1>(part<0, n>(given), p);
        Vector<U, n> out;
        for (int i = 0; i < n; ++i) out(i) = flow(n + i).at(h) - given(n + i);
        return out;
      };
      Vector<double, n> guess;
      for (int i = 0; i < n; ++i) guess(i) = value_of(p1(i));
      return solve_implicit<S, n, 2 * n>(residual, guess, joined(q0, p1));
    }
  }
};

}  // namespace lagroid
