#pragma once
/// Derivatives of functions over any scalar, over that scalar: one dual number for each direction.

#include <lagroid/core/dual.hpp>

namespace lagroid {

/// d/dt f(x + t v) at t = 0, of the type of f(x): S, or a vector of them. f takes Vector<Dual<S>, N>.
template <class S, int N, class F> auto derivative_along(const F& f, const Vector<S, N>& x, const Vector<S, N>& v) {
  Vector<Dual<S>, N> moved(x.size());
  for (int i = 0; i < x.size(); ++i) moved(i) = Dual<S>(x(i), v(i));
  const auto there = f(moved);
  if constexpr (requires { there.derivative; }) {
    return there.derivative;
  } else {
    return derivative_of(there);
  }
}

/// The derivatives of f : R^N -> R, N passes.
template <class S, int N, class F> Vector<S, N> gradient_of(const F& f, const Vector<S, N>& x) {
  Vector<S, N> out;
  for (int i = 0; i < N; ++i) {
    Vector<S, N> unit;
    for (int j = 0; j < N; ++j) unit(j) = S(i == j ? 1.0 : 0.0);
    out(i) = derivative_along(f, x, unit);
  }
  return out;
}

/// Row i is the derivative of f_i, f : R^N -> R^D.
template <int D, class S, int N, class F> Matrix<S, D, N> jacobian_of(const F& f, const Vector<S, N>& x) {
  Matrix<S, D, N> out;
  for (int j = 0; j < N; ++j) {
    Vector<S, N> unit;
    for (int i = 0; i < N; ++i) unit(i) = S(i == j ? 1.0 : 0.0);
    const Vector<S, D> column = derivative_along(f, x, unit);
    for (int i = 0; i < D; ++i) out(i, j) = column(i);
  }
  return out;
}

/// (a, b) as one vector. Like `part` by components: Eigen's expressions over nested scalars cost the compiler seconds
/// each.
template <class S, int N, int M> Vector<S, N + M> joined(const Vector<S, N>& a, const Vector<S, M>& b) {
  Vector<S, N + M> out;
  for (int i = 0; i < N; ++i) out(i) = a(i);
  for (int i = 0; i < M; ++i) out(N + i) = b(i);
  return out;
}
/// (x_Begin, ..., x_{Begin + Count - 1}).
template <int Begin, int Count, class S, int N> Vector<S, Count> part(const Vector<S, N>& x) {
  static_assert(Begin + Count <= N);
  Vector<S, Count> out;
  for (int i = 0; i < Count; ++i) out(i) = x(Begin + i);
  return out;
}
/// x as constants of the scalar S.
template <class S, class T, int N> Vector<S, N> constants(const Vector<T, N>& x) {
  Vector<S, N> out;
  for (int i = 0; i < N; ++i) out(i) = S(x(i));
  return out;
}

}  // namespace lagroid
