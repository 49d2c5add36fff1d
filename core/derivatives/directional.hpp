#pragma once
/// Derivatives of functions over any scalar, exact, one dual number for each direction: df/dt (x + t v), gradients,
/// Jacobians.
///
/// They nest, since the scalar may itself have derivatives; for many directions of one function, Jet is faster.
///
///     const auto f = [](const auto& x) { return x(0) * x(0) + x(1); };
///     const Vector<double, 2> df = gradient_of(f, Vector<double, 2>(1, 2));  // (2, 1)
///     const double along = derivative_along(f, Vector<double, 2>(1, 2), Vector<double, 2>(0, 3));  // 3
///
/// Requires an f that takes Vector<Dual<S>, N> and returns a value, not an expression of Eigen. Nothing throws.

#include <lagroid/core/scalars/dual.hpp>

namespace lagroid {

/// x + e v, e the infinitesimal.
template <class S, int N> Vector<Dual<S>, N> moved_along(const Vector<S, N>& x, const Vector<S, N>& v) {
  Vector<Dual<S>, N> out(x.size());
  for (int i = 0; i < x.size(); ++i) out(i) = Dual<S>(x(i), v(i));
  return out;
}

/// e_i, by components (see `joined`).
template <class S, int N> Vector<S, N> unit_vector(int i) {
  Vector<S, N> out;
  for (int j = 0; j < N; ++j) out(j) = S(i == j ? 1.0 : 0.0);
  return out;
}

/// d/dt f(x + t v) at t = 0, of the type of f(x): S, or a vector of them. f takes Vector<Dual<S>, N>.
template <class S, int N, class F> auto derivative_along(const F& f, const Vector<S, N>& x, const Vector<S, N>& v) {
  const auto there = f(moved_along(x, v));
  if constexpr (requires { there.derivative; }) {
    return there.derivative;
  } else {
    return derivative_of(there);
  }
}

/// The derivatives of f : R^N -> R, N passes.
template <class S, int N, class F> Vector<S, N> gradient_of(const F& f, const Vector<S, N>& x) {
  Vector<S, N> out;
  for (int i = 0; i < N; ++i) out(i) = derivative_along(f, x, unit_vector<S, N>(i));
  return out;
}

/// The same for the numbers of a matrix of any size, and f(x) with it. No allocation: `moved` is as large, of dual
/// numbers.
template <class X, class Moved, class F>
typename X::Scalar value_and_gradient_of(const F& f, const X& x, Moved& moved, X& gradient) {
  using S = typename X::Scalar;
  S value(0.0);
  for (Eigen::Index i = 0; i < x.size(); ++i) moved.data()[i] = Dual<S>(x.data()[i], S(0.0));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    moved.data()[i].derivative = S(1.0);
    const Dual<S> along = f(moved);
    moved.data()[i].derivative = S(0.0);
    gradient.data()[i] = along.derivative;
    value = along.value;
  }
  return value;
}

/// Row i is the derivative of f_i, f : R^N -> R^D.
template <int D, class S, int N, class F> Matrix<S, D, N> jacobian_of(const F& f, const Vector<S, N>& x) {
  Matrix<S, D, N> out;
  for (int j = 0; j < N; ++j) {
    const Vector<S, D> column = derivative_along(f, x, unit_vector<S, N>(j));
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
