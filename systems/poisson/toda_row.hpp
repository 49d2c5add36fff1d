#pragma once
/// Toda's lattice by its particles, on the pair groupoid, from which the bracket of Flaschka's variables is reduced by
/// translations:
///
///     L(q0, q1) = |q1 - q0|^2 / 2h - h (U(q0) + U(q1)) / 2,    U(q) = sum exp(q_i - q_{i+1}).
///
///     TodaRow<4> row;
///     row.h = 0.05;
///     const Vector<double, 7> reduced = flaschka<4>({0.3, 0.1, -0.2, 0}, {0.2, -0.4, 0.1, 0.3});  // of OpenToda<4>
///
/// Requires a step above zero. Nothing throws.
///
/// Source: Flaschka, The Toda lattice II, 1974.

#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <cmath>

namespace lagroid {

template <int K> struct TodaRow : System<TodaRow<K>, Pair<K>> {
  using Base = System<TodaRow<K>, Pair<K>>;
  double h = 0.01;

  template <class S, class T> S lagrangian(const typename Base::template Arrow<S>& g, const T& step) const {
    S kinetic(0.0);
    for (int i = 0; i < K; ++i) kinetic += (g.target(i) - g.source(i)) * (g.target(i) - g.source(i));
    return kinetic * 0.5 / step - (potential(g.source) + potential(g.target)) * (0.5 * step);
  }
  template <class S> S lagrangian(const typename Base::template Arrow<S>& g) const { return lagrangian(g, h); }
  template <class S> S potential(const Vector<S, K>& q) const {
    using std::exp;
    S sum(0.0);
    for (int i = 0; i + 1 < K; ++i) sum += exp(q(i) - q(i + 1));
    return sum;
  }
};

/// (a, b) with a_i = exp((q_i - q_{i+1}) / 2) / 2 and b_i = - p_i / 2.
template <int K> Vector<double, 2 * K - 1> flaschka(const Vector<double, K>& q, const Vector<double, K>& p) {
  Vector<double, 2 * K - 1> x;
  for (int i = 0; i + 1 < K; ++i) x(i) = 0.5 * std::exp(0.5 * (q(i) - q(i + 1)));
  x.template tail<K>() = -0.5 * p;
  return x;
}

}  // namespace lagroid
