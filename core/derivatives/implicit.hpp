#pragma once
/// Functions x(y) that are defined by equations F(x, y) = 0, over any scalar, with their derivatives.
///
/// A generating function or a Legendre transform that must be solved for is then used, and differentiated, like a
/// formula.
///
///     const auto residual = [](const auto& x, const auto& y) { return (x.cwiseProduct(x) - y).eval(); };
///     const Vector<double, 1> guess(1.0);
///     const auto root = solve_implicit<double, 1, 1>(residual, guess, Vector<double, 1>(2.0));  // sqrt(2)
///
/// Requires an F over any scalar, Vector<U, N> x Vector<U, M> -> Vector<U, N>, whose derivative F_x is regular at the
/// solution. Returns x over the scalar of y; nothing is allocated.
///
/// Errors: the numbers of x are not numbers (NaN) where Newton's method does not converge from the guess.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/scalars/series.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace lagroid {

/// The largest number of infinitesimals of the scalar S that have a product other than zero.
template <class S> inline constexpr int nilpotency = 0;
template <Differentiated S> inline constexpr int nilpotency<S> = S::order + nilpotency<typename S::Real>;
template <class T> inline constexpr int nilpotency<Dual<T>> = 1 + nilpotency<T>;
template <class T, int K> inline constexpr int nilpotency<Series<T, K>> = K - 1 + nilpotency<T>;

/// The plain number that a scalar has, however deep its derivatives are nested.
template <class S> double number_of(const S& x) {
  if constexpr (std::is_arithmetic_v<S>) {
    return double(x);
  } else {
    static_assert(!std::is_same_v<std::remove_cvref_t<decltype(value_of(x))>, S>,
                  "what is solved for inside a formula is solved for one number, not for the lanes of a Batch");
    return number_of(value_of(x));
  }
}

namespace detail {

/// A solution x and the inverse of F_x there.
template <int N> struct Root {
  Vector<double, N> x;
  Matrix<double, N, N> inverse;
};

/// Equations at a point: their values, their derivatives, the largest value, and the largest ratio of one to its
/// rounding.
template <int N> struct EquationsAt {
  Vector<double, N> value;
  Matrix<double, N, N> jacobian;
  double largest = 0;
  double roundoff_ratio = 0;

  /// Value i, the sum of terms of that size.
  void measure(int i, double terms) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const bool finite = std::isfinite(value(i)) && std::isfinite(terms);
    const double size = finite ? std::abs(value(i)) : INFINITY;
    largest = std::max(largest, size);
    if (size > 0) roundoff_ratio = std::max(roundoff_ratio, finite ? size / (rounding * terms) : INFINITY);
  }
};

/// By Newton's method, with steps halved until the residual falls, until each equation is left with the rounding of its
/// terms. at(x) returns EquationsAt<N>. Not a number where that does not come about.
template <int N, class At> Root<N> newton_iteration(const At& at, const Vector<double, N>& guess) {
  constexpr int most_iterations = 60;
  constexpr int most_halvings = 20;
  constexpr double floor = 100;  // times its rounding is as far as some get
  Root<N> root{guess, {}};
  EquationsAt<N> now = at(root.x);
  double last = INFINITY;
  for (int iteration = 0; iteration < most_iterations && std::isfinite(now.largest); ++iteration) {
    root.inverse = now.jacobian.inverse();
    const Vector<double, N> step = root.inverse * now.value;
    bool finite = true;
    for (double x : step) finite = finite && std::isfinite(x);
    if (!finite) break;
    const auto moved = [&](double part) {
      Vector<double, N> x;
      for (int i = 0; i < N; ++i) x(i) = root.x(i) - part * step(i);
      return x;
    };
    if (now.roundoff_ratio <= 1 || (now.roundoff_ratio <= floor && now.roundoff_ratio >= last / 2)) {
      root.x = moved(1);
      return root;
    }
    last = now.roundoff_ratio;
    double part = 1;
    EquationsAt<N> next = at(moved(1));
    for (int halving = 0; halving < most_halvings && !(next.largest < now.largest) && !(next.roundoff_ratio <= floor);
         ++halving)
      next = at(moved(part /= 2));
    root.x = moved(part);
    now = next;
  }
  for (double& x : root.x) x = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < N * N; ++i) root.inverse(i) = std::numeric_limits<double>::quiet_NaN();
  return root;
}

/// The same for F(x, parameters), whose terms are its derivatives times what they multiply, unknowns and parameters.
template <int N, int M, class F>
Root<N> newton_root(const F& residual, const Vector<double, N>& guess, const Vector<double, M>& parameters) {
  using J = Jet<double, N + M>;
  const auto at = [&](const Vector<double, N>& x) {
    Vector<J, N> unknown;
    Vector<J, M> fixed;
    for (int i = 0; i < N; ++i) unknown(i) = J::variable(x(i), i);
    for (int i = 0; i < M; ++i) fixed(i) = J::variable(parameters(i), N + i);
    const Vector<J, N> f = residual(unknown, fixed);
    EquationsAt<N> out;
    for (int i = 0; i < N; ++i) {
      const Vector<double, N + M> slope = f(i).gradient();
      out.value(i) = f(i).value;
      double terms = 0;
      for (int j = 0; j < N; ++j) {
        out.jacobian(i, j) = slope(j);
        terms += std::abs(slope(j) * x(j));
      }
      for (int j = 0; j < M; ++j) terms += std::abs(slope(N + j) * parameters(j));
      out.measure(i, terms);
    }
    return out;
  };
  return newton_iteration<N>(at, guess);
}

/// A root x over the scalar S, its infinitesimals taken in by as many corrections x -= F_x^{-1} F, F_x^{-1} kept in
/// plain numbers, as there are orders of them, for each is right in one order more. (Half as many do for a function
/// that is stationary in x.)
template <class S, int N, class F>
Vector<S, N> with_infinitesimals(const Root<N>& root, const F& residual, int corrections = nilpotency<S>) {
  Vector<S, N> x;
  for (int i = 0; i < N; ++i) x(i) = S(root.x(i));
  for (int order = 0; order < corrections; ++order) {
    const Vector<S, N> f = residual(x);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) x(i) -= f(j) * root.inverse(i, j);
  }
  return x;
}

}  // namespace detail

/// x(y) with F(x, y) = 0, with its derivatives: the values by Newton's method, the infinitesimals by corrections. F(x,
/// y) is a function over any scalar, Vector<U, N> x Vector<U, M> -> Vector<U, N>. Not a number where Newton's method
/// does not converge from `guess`. No allocation.
template <class S, int N, int M, class F>
Vector<S, N> solve_implicit(const F& residual, const Vector<double, N>& guess, const Vector<S, M>& parameters) {
  Vector<double, M> values;
  for (int i = 0; i < M; ++i) values(i) = number_of(parameters(i));
  return detail::with_infinitesimals<S, N>(detail::newton_root<N, M>(residual, guess, values),
                                           [&](const Vector<S, N>& x) { return residual(x, parameters); });
}

}  // namespace lagroid
