#pragma once
/// The generating function of the exact flow in Karasev's chart, from the Hamilton-Jacobi equation
///
///     dS/dt = H(beta(x, dS)),    S = t H + t^3 S_3 + t^5 S_5 + O(t^7):
///
/// a step with p = dS(x) in place of t dH(x) has order 4 or 6 and keeps the bracket as exactly.
///
///     S_3 = H_ij X^i X^j / 24,    X = pi dH
///
///     const Vector<double, 2> x(2, 0.5);
///     const double third = third_order_energy(LotkaVolterra{}, x);
///     const double fifth = fifth_order_energy(LotkaVolterra{}, x);
///
/// Requires bivector and energy over nested scalars. Returns S_3 and S_5 over the scalar of x; another chart has
/// others. Nothing throws.
///
/// Source: Cabrera, Martin de Diego, Vaquero, arXiv 2409.04342 (the equation).

#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/core/scalars/series.hpp>

namespace lagroid {

namespace detail {

/// x + t v + e w, t up to `Terms` - 1.
template <int Terms, class S, int N> Vector<Series<S, Terms>, N> along(const Vector<S, N>& x, const Vector<S, N>& v) {
  Vector<Series<S, Terms>, N> at;
  for (int i = 0; i < N; ++i) {
    at(i) = Series<S, Terms>(x(i));
    at(i)[1] = v(i);
  }
  return at;
}

}  // namespace detail

/// S_3(x).
template <class Sys, class S, int N> S third_order_energy(const Sys& system, const Vector<S, N>& x) {
  return system.hamiltonian(detail::along<3>(x, system.velocity(x)))[2] * (1.0 / 12);
}
template <class Sys, class S, int N> Vector<S, N> third_order_gradient(const Sys& system, const Vector<S, N>& x) {
  return gradient_of([&](const auto& y) { return third_order_energy(system, y); }, x);
}

/// S_5(x), with b_2 = f'f/12 and b_3 = f''(f, f)/48 of f = pi p at p = dH, and Y = pi dS_3:
///
///     5 S_5 = H_i X^k d_k pi^{ij} d_j S_3 / 12 + H_ij X^i (Y^j / 4 + b_3^j / 2) + H_ij b_2^i b_2^j / 2
///             + H_ijk X^i X^j b_2^k / 8 + H_ijkl X^i X^j X^k X^l / 384.
template <class Sys, class S, int N> S fifth_order_energy(const Sys& system, const Vector<S, N>& x) {
  const Vector<S, N> slope = system.gradient(x);
  const Vector<S, N> velocity = system.field(x, slope);
  const Vector<S, N> third = third_order_gradient(system, x);
  const Vector<S, N> y = system.field(x, third);
  const auto field = system.field(detail::along<3>(x, velocity), constants<Series<S, 3>>(slope));
  const auto turned = system.field(moved_along(x, velocity), constants<Dual<S>>(third));

  S first(0.0);
  Vector<S, N> b2;
  Vector<S, N> beside;  // Y / 4 + b_3 / 2
  for (int i = 0; i < N; ++i) {
    first += slope(i) * turned(i).derivative;
    b2(i) = field(i)[1] * (1.0 / 12);
    beside(i) = y(i) * 0.25 + field(i)[2] * (1.0 / 48);
  }
  Vector<Dual<Dual<S>>, N> both;
  Vector<Series<Dual<S>, 3>, N> curved;
  for (int i = 0; i < N; ++i) {
    both(i) = Dual<Dual<S>>(Dual<S>(x(i), velocity(i)), Dual<S>(beside(i), S(0.0)));
    curved(i) = Series<Dual<S>, 3>(Dual<S>(x(i), b2(i)));
    curved(i)[1] = Dual<S>(velocity(i), S(0.0));
  }
  const S mixed = system.hamiltonian(both).derivative.derivative;
  const S of_b2 = system.hamiltonian(detail::along<3>(x, b2))[2];
  const S cubic = system.hamiltonian(curved)[2].derivative * 0.25;
  const S quartic = system.hamiltonian(detail::along<5>(x, velocity))[4] * (1.0 / 16);
  return (first * (1.0 / 12) + mixed + of_b2 + cubic + quartic) * 0.2;
}
template <class Sys, class S, int N> Vector<S, N> fifth_order_gradient(const Sys& system, const Vector<S, N>& x) {
  return gradient_of([&](const auto& y) { return fifth_order_energy(system, y); }, x);
}

}  // namespace lagroid
