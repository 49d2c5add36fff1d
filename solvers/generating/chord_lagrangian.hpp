#pragma once
/// Discrete Lagrangians along chords, generating functions of type I from a continuous Lagrangian L(q, v):
///
///     L_d(q0, q1) = h sum b_i L(q0 + c_i (q1 - q0), (q1 - q0) / h).
///
/// The quickest way to a variational integrator: L is written once, the quadrature chosen. The trapezoid gives
/// Stormer-Verlet, with constraints RATTLE.
///
///     struct Spring {
///       static constexpr int dimension = 1, constraints = 0;
///       template <class S> S lagrangian(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
///         return (v(0) * v(0) - q(0) * q(0)) * 0.5;
///       }
///     };
///     inline const ChordLagrangian<Spring> discrete{{}, quadrature_rules::trapezoid};
///
/// The step is taken by HamiltonianMap (hamiltonian_map.hpp).

#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/core/hamiltonian/quadrature_rule.hpp>

namespace lagroid {

/// L_d(q0, q1) = h sum b_i L(q0 + c_i (q1 - q0), (q1 - q0) / h), of type I, for a system that writes
///
///     static constexpr int dimension, constraints;
///     template <class S> S lagrangian(const Vector<S, n>& q, const Vector<S, n>& v) const
///
/// With the trapezoid, for L = v.M v / 2 - U(q): Stormer-Verlet, with constraints SHAKE, with tangent momenta RATTLE.
template <class M> struct ChordLagrangian {
  static constexpr int dimension = M::dimension;
  static constexpr int constraints = M::constraints;
  static constexpr GeneratingType type = GeneratingType::one;
  M system;
  QuadratureRule rule = quadrature_rules::trapezoid;

  template <class S, int N> S generating(const Vector<S, N>& q0, const Vector<S, N>& q1, double h) const {
    Vector<S, N> velocity;
    for (int i = 0; i < N; ++i) velocity(i) = (q1(i) - q0(i)) * (1 / h);
    S sum(0.0);
    for (std::size_t node = 0; node < rule.nodes.size(); ++node) {
      const double c = rule.nodes[node];
      Vector<S, N> q;
      for (int i = 0; i < N; ++i) q(i) = q0(i) * (1 - c) + q1(i) * c;
      sum += system.lagrangian(q, velocity) * (h * rule.weights[node]);
    }
    return sum;
  }
  template <class S, int N> auto constraint(const Vector<S, N>& q) const { return system.constraint(q); }
};

}  // namespace lagroid
