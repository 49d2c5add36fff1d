#pragma once
/// Analytic functions of which the exponential and logarithm of rotations are made, free of cancellation near zero: the
/// Stumpff functions c_K(x) = sum_i (-x)^i / (2i + K)!, and the ratio of a rotation angle to the sine of its half.
///
/// Both families take an argument in which they are analytic (a squared angle, a cosine), so that they can be
/// differentiated at the identity, where the angle itself cannot.
///
///     const double x = w.squaredNorm();  // of a rotation vector
///     const double sinc = stumpff<1>(x), versine = stumpff<2>(x);  // sin|w| / |w|, (1 - cos|w|) / |w|^2
///
/// Requires x >= 0; for the ratio, -1 < w <= 1. Nothing throws.

#include <array>
#include <cmath>
#include <concepts>
#include <limits>

namespace lagroid {

namespace detail {

template <int K> constexpr double factorial = K* factorial<K - 1>;
template <> inline constexpr double factorial<0> = 1.0;

/// sum_i c_i x^i over the first `terms` coefficients.
template <std::floating_point T, std::size_t N> T horner(const std::array<T, N>& c, int terms, T x) {
  T sum = c[std::size_t(terms) - 1];
  for (int i = terms - 2; i >= 0; --i) sum = c[std::size_t(i)] + x * sum;
  return sum;
}

/// (-1)^i / (2i + K)!.
template <int K, std::floating_point T, int Terms>
inline constexpr std::array<T, Terms> stumpff_coefficients = [] {
  std::array<T, Terms> c{};
  T term = T(1) / T(factorial<K>);
  for (int i = 0; i < Terms; ++i) {
    c[std::size_t(i)] = term;
    term /= -T(2 * i + K + 1) * T(2 * i + K + 2);
  }
  return c;
}();

/// Coefficients in u = 1 - w of the Order-th derivative in w of 2 acos(w) / sqrt(1 - w^2) = 2 sum_k b_k u^k,
/// b_{k+1} / b_k = (k + 1) / (2k + 3).
template <int Order, std::floating_point T, int Terms>
inline constexpr std::array<T, Terms> angle_ratio_coefficients = [] {
  std::array<T, Terms> c{};
  T b = 2;
  for (int k = 0; k < Terms + Order; ++k) {
    T falling = Order % 2 == 0 ? T(1) : T(-1);
    for (int j = 0; j < Order; ++j) falling *= T(k - j);
    if (k >= Order) c[std::size_t(k - Order)] = falling * b;
    b *= T(k + 1) / T(2 * k + 3);
  }
  return c;
}();

}  // namespace detail

/// Stumpff function c_K(x) = sum_i (-x)^i / (2i + K)!.
///
/// With x = a^2: c_0 = cos a, c_1 = sin a / a, c_2 = (1 - cos a)/a^2, c_3 = (a - sin a)/a^3.
/// Requires x >= 0. Error a few round-offs, relative to 1/K!, for
/// K <= 3 at every x.
template <int K, std::floating_point T> T stumpff(T x) {
  static_assert(K >= 0);
  constexpr T series_limit = 4;
  if (x < series_limit) {
    constexpr bool extended = std::numeric_limits<T>::digits > 60;
    constexpr int terms = extended ? 18 : 15;
    const int needed = extended ? terms : x < T(0.01) ? 5 : x < T(0.25) ? 8 : terms;
    return detail::horner(detail::stumpff_coefficients<K, T, terms>, needed, x);
  }
  if constexpr (K == 0) {
    return std::cos(std::sqrt(x));
  } else if constexpr (K == 1) {
    const T a = std::sqrt(x);
    return std::sin(a) / a;
  } else if constexpr (K == 2) {
    const T s = std::sin(std::sqrt(x) / 2);
    return 2 * s * s / x;
  } else {
    return (T(1) / T(detail::factorial<K - 2>) - stumpff<K - 2>(x)) / x;
  }
}

/// d c_K / dx = -(c_{K+1} - K c_{K+2}) / 2, for any scalar on which stumpff is defined.
template <int K, class S> S stumpff_derivative(const S& x) {
  return (stumpff<K + 1>(x) - S(double(K)) * stumpff<K + 2>(x)) * S(-0.5);
}

/// The n-th derivative (n = 0, 1, 2, 3) of f(w) = 2 acos(w) / sqrt(1 - w^2), the ratio of a rotation angle to the norm
/// of the vector part of its unit quaternion with scalar part w. Requires -1 < w <= 1 (up to round-off above 1).
template <int Order, std::floating_point T> T angle_ratio(T w) {
  static_assert(0 <= Order && Order <= 3);
  const T u = 1 - w;
  if (u < T(0.1)) {
    constexpr bool extended = std::numeric_limits<T>::digits > 60;
    constexpr int terms = 22;
    const int needed = extended ? terms : u < T(1e-3) ? 7 : u < T(1e-2) ? 10 : terms;
    return detail::horner(detail::angle_ratio_coefficients<Order, T, terms>, needed, u);
  }
  const T s2 = (1 - w) * (1 + w);
  if constexpr (Order == 0) {
    return 2 * std::acos(w) / std::sqrt(s2);
  } else if constexpr (Order == 1) {
    return (w * angle_ratio<0>(w) - 2) / s2;
  } else if constexpr (Order == 2) {
    return (angle_ratio<0>(w) + 3 * w * angle_ratio<1>(w)) / s2;
  } else {
    return (4 * angle_ratio<1>(w) + 5 * w * angle_ratio<2>(w)) / s2;
  }
}

}  // namespace lagroid
