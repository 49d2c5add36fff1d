#pragma once
/// Functions that are defined by equations, over any scalar.

#include <lagroid/core/directional.hpp>
#include <lagroid/core/jet.hpp>
#include <lagroid/core/series.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <limits>

namespace lagroid {

/// The largest number of infinitesimals of the scalar S that have a product other than zero.
template <class S> inline constexpr int nilpotency = 0;
template <Differentiated S> inline constexpr int nilpotency<S> = S::order;
template <class T> inline constexpr int nilpotency<Dual<T>> = 1 + nilpotency<T>;
template <class T, int K> inline constexpr int nilpotency<Series<T, K>> = K - 1 + nilpotency<T>;

namespace detail {

/// A solution x and the inverse of F_x there.
template <int N> struct Root {
  Vector<double, N> x;
  Matrix<double, N, N> inverse;
};

/// By Newton's method, with steps halved until the residual falls.
template <int N, int M, class F>
Root<N> newton_root(const F& residual, const Vector<double, N>& guess, const Vector<double, M>& parameters) {
  using J = Jet<double, N>;
  constexpr int most_iterations = 60;
  constexpr int most_halvings = 20;
  constexpr double nearly_done = 1e-10;  // the square of what is left then is round-off
  constexpr double slow = 1e-6;          // steps this small that do not fall are round-off
  const Vector<J, M> fixed = constants<J>(parameters);
  const auto at = [&](const Vector<double, N>& x) {
    Vector<J, N> seed;
    for (int i = 0; i < N; ++i) seed(i) = J::variable(x(i), i);
    return Vector<J, N>(residual(seed, fixed));
  };
  const auto norm = [](const Vector<J, N>& r) {
    double largest = 0;
    for (int i = 0; i < N; ++i)
      largest = std::isfinite(r(i).value) ? std::max(largest, std::abs(r(i).value)) : INFINITY;
    return largest;
  };
  Root<N> root{guess, {}};
  Vector<J, N> f = at(root.x);
  double last = INFINITY;
  double size = root.x.cwiseAbs().maxCoeff();
  for (int iteration = 0; iteration < most_iterations && std::isfinite(norm(f)); ++iteration) {
    Matrix<double, N, N> jacobian;
    Vector<double, N> value;
    for (int i = 0; i < N; ++i) {
      value(i) = f(i).value;
      jacobian.row(i) = f(i).gradient().transpose();
    }
    root.inverse = jacobian.inverse();
    const Vector<double, N> step = root.inverse * value;
    const double length = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(length)) break;
    size = std::max(size, (root.x - step).cwiseAbs().maxCoeff());
    if (length <= nearly_done * size || (length <= slow * size && length >= last / 2)) {
      root.x -= step;
      return root;
    }
    last = length;
    double part = 1;
    Vector<J, N> next = at(root.x - step);
    for (int halving = 0; halving < most_halvings && !(norm(next) < norm(f)) && length > slow * size; ++halving)
      next = at(root.x - (part /= 2) * step);
    root.x -= part * step;
    f = next;
  }
  root.x.setConstant(std::numeric_limits<double>::quiet_NaN());
  root.inverse.setConstant(std::numeric_limits<double>::quiet_NaN());
  return root;
}

}  // namespace detail

/// x(y) with F(x, y) = 0, with its derivatives: the values by Newton's method, the infinitesimals by as many
/// corrections x -= F_x^{-1} F, F_x^{-1} kept in plain numbers, as there are orders of them, for each is right in one
/// order more. F(x, y) is a function over any scalar, Vector<U, N> x Vector<U, M> -> Vector<U, N>. Not a number where
/// Newton's method does not converge from `guess`. No allocation.
template <class S, int N, int M, class F>
Vector<S, N> solve_implicit(const F& residual, const Vector<double, N>& guess, const Vector<S, M>& parameters) {
  Vector<double, M> values;
  for (int i = 0; i < M; ++i) values(i) = value_of(parameters(i));
  const detail::Root<N> root = detail::newton_root<N, M>(residual, guess, values);
  Vector<S, N> x;
  for (int i = 0; i < N; ++i) x(i) = S(root.x(i));
  for (int order = 0; order < nilpotency<S>; ++order) {
    const Vector<S, N> f = residual(x, parameters);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) x(i) -= f(j) * root.inverse(i, j);
  }
  return x;
}

}  // namespace lagroid
