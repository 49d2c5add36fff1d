#pragma once
/// The reported momentum (constrained_momentum.hpp) with its derivatives: mu + <nu, omega(q)>, nu of the linear
/// equations
///
///     M w - <nu, omega> = mu - mu_0,    <omega, w> + phi(e) = 0,
///
/// whose matrix and side are known with their derivatives: A x = b, A x' = b' - A' x.
///
///     const Vector<VariedNumber, n> p = varied_tangent_momentum(system, q, mu);
///
/// Requirements are those of `tangent_momentum`; for systems without object or nonholonomic constraints it is mu
/// itself.

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/solvers/sensitivity/linearised_step.hpp>

namespace lagroid {

namespace detail {

/// x with A x = b.
template <int N>
Vector<VariedNumber, N> solve_varied(const Matrix<VariedNumber, N, N>& a, const Vector<VariedNumber, N>& b) {
  Matrix<double, N, N> matrix;
  Vector<double, N> side;
  for (int i = 0; i < N; ++i) {
    side(i) = b(i).value;
    for (int j = 0; j < N; ++j) matrix(i, j) = a(i, j).value;
  }
  const Vector<double, N> x = lagroid::solve_equilibrated(matrix, side);
  Vector<VariedNumber, N> out;
  for (int i = 0; i < N; ++i) out(i) = VariedNumber(x(i));
  for (int direction = 0; direction < varied_at_once; ++direction) {
    for (int i = 0; i < N; ++i) {
      side(i) = b(i).tangent(direction);
      for (int j = 0; j < N; ++j) side(i) -= a(i, j).tangent(direction) * x(j);
    }
    const Vector<double, N> along = lagroid::solve_equilibrated(matrix, side);
    for (int i = 0; i < N; ++i) out(i) += VariedNumber::variable(0, direction) * along(i);
  }
  return out;
}

}  // namespace detail

template <DiscreteSystem Sys>
AlgebroidVector<typename Sys::GroupoidType, VariedNumber> varied_tangent_momentum(
    const Sys& system, const ObjectOf<typename Sys::GroupoidType, VariedNumber>& object,
    const AlgebroidVector<typename Sys::GroupoidType, VariedNumber>& momentum) {
  if constexpr (!Nonholonomic<Sys> && Sys::object_constraints == 0) {
    return momentum;
  } else {
    using V = VariedNumber;
    using M = HyperDual<V, Sys::dimension, Sys::dimension>;
    constexpr int n = Sys::dimension;
    constexpr int phis = Sys::arrow_constraints;
    constexpr int size = n + Sys::constraints;
    const auto unit = system.groupoid.unit(object);
    const auto moved = system.groupoid.template seed<M, End::source, End::target>(unit);
    const M lagrangian = system.lagrangian(moved);
    Matrix<V, size, size> a = Matrix<V, size, size>::Constant(V(0));
    Vector<V, size> b = Vector<V, size>::Constant(V(0));
    Matrix<V, n, Sys::constraints> reaction;
    for (int i = 0; i < n; ++i) {
      b(i) = momentum(i) - (lagrangian.right(i) - lagrangian.left(i)) * 0.5;
      for (int j = 0; j < n; ++j) a(i, j) = -lagrangian.mixed(i, j);
    }
    const auto stand = [&](int k, const auto& at_source, const auto& at_target) {
      for (int i = 0; i < n; ++i) {
        reaction(i, k) = at_source(i);
        a(i, n + k) = -at_source(i);
        a(n + k, i) = at_target(i);
      }
    };
    if constexpr (Nonholonomic<Sys>) {
      const Matrix<V, n, phis> omega = annihilator<Sys, V>(system, object);
      const Vector<V, phis> phi = system.constraint(unit);
      for (int k = 0; k < phis; ++k) {
        stand(
            k, [&](int i) { return omega(i, k); }, [&](int i) { return omega(i, k); });
        b(n + k) = -phi(k);
      }
    } else if constexpr (phis > 0) {
      const Vector<M, phis> phi = system.constraint(moved);
      for (int k = 0; k < phis; ++k) {
        stand(
            k, [&](int i) { return phi(k).left(i); }, [&](int i) { return phi(k).right(i); });
        b(n + k) = -phi(k).value;
      }
    }
    if constexpr (Sys::object_constraints > 0) {
      const auto source = system.object_constraint(system.groupoid.source(moved));
      const auto target = system.object_constraint(system.groupoid.target(moved));
      for (int k = 0; k < Sys::object_constraints; ++k)
        stand(
            phis + k, [&](int i) { return source(k).left(i); }, [&](int i) { return target(k).right(i); });
    }
    const Vector<V, size> x = detail::solve_varied<size>(a, b);
    AlgebroidVector<typename Sys::GroupoidType, V> out = momentum;
    for (int k = Nonholonomic<Sys> ? 0 : phis; k < Sys::constraints; ++k)
      for (int i = 0; i < n; ++i) out(i) += reaction(i, k) * x(n + k);
    return out;
  }
}

}  // namespace lagroid
