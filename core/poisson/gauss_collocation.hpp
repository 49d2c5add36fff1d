#pragma once
/// The solution of y' = f(y) over a unit of time and its mean, to round-off, by collocation at the nodes of Gauss.
///
/// Where f is small, as a step makes it, a few passes over eight nodes leave nothing to be gained, whatever the scalar;
/// a power series would need f's own recurrences.
///
///     const auto decay = [](const auto& y) { return Vector<double, 1>(-0.1 * y(0)); };
///     const auto arc = gauss_arc(decay, Vector<double, 1>(1.0));  // arc.end(0) = exp(-0.1)
///
/// Requires f : Vector<S, N> -> Vector<S, N>, smooth along the arc. Returns the end, the mean over the arc, and whether
/// both are known to round-off: the unit is cut into parts until the last Legendre coefficients of f are too small to
/// matter, at most `most_parts`. Nothing is allocated, nothing throws.
///
/// Source: Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2006, II.1.

#include <lagroid/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

namespace lagroid {

/// Nodes c_i and weights b_i on [0, 1], a_ij = int_0^{c_i} l_j, and P_m(2 c_i - 1).
template <int Nodes> struct GaussNodes {
  using Row = std::array<double, std::size_t(Nodes)>;
  Row node{};
  Row weight{};
  std::array<Row, std::size_t(Nodes)> integral{};
  std::array<Row, std::size_t(Nodes)> legendre{};  ///< [m][i]

  constexpr GaussNodes() {
    for (int i = 0; i < Nodes; ++i) {
      // Zeros of P_Nodes, by bisection between points where its sign is known to change.
      const long double z = zero(Nodes - 1 - i);
      const auto p = polynomials(z);
      const long double slope = Nodes * (z * p[Nodes] - p[Nodes - 1]) / (z * z - 1);
      node[std::size_t(i)] = double((1 + z) / 2);
      weight[std::size_t(i)] = double(1 / ((1 - z * z) * slope * slope));
      for (int m = 0; m < Nodes; ++m) legendre[std::size_t(m)][std::size_t(i)] = double(p[std::size_t(m)]);
      exact_[std::size_t(i)] = p;
    }
    for (std::size_t i = 0; i < std::size_t(Nodes); ++i)
      for (std::size_t j = 0; j < std::size_t(Nodes); ++j) {
        long double sum = (1 + exact_[i][1]) / 2;
        for (std::size_t m = 1; m < std::size_t(Nodes); ++m)
          sum += exact_[j][m] * (exact_[i][m + 1] - exact_[i][m - 1]) / 2;
        integral[i][j] = double(weight[j] * sum);
      }
  }

 private:
  using Values = std::array<long double, std::size_t(Nodes + 1)>;
  std::array<Values, std::size_t(Nodes)> exact_{};

  static constexpr Values polynomials(long double z) {
    Values p{};
    p[0] = 1;
    p[1] = z;
    for (std::size_t m = 1; m < std::size_t(Nodes); ++m)
      p[m + 1] = (static_cast<long double>(2 * m + 1) * z * p[m] - static_cast<long double>(m) * p[m - 1]) /
                 static_cast<long double>(m + 1);
    return p;
  }
  /// The k-th zero from above.
  static constexpr long double zero(int k) {
    constexpr int cells = 40 * Nodes;
    long double above = 1;
    int found = -1;
    for (int cell = 1; cell <= cells; ++cell) {
      long double below = 1 - 2 * static_cast<long double>(cell) / cells + 1e-9L;
      if ((polynomials(above)[Nodes] > 0) != (polynomials(below)[Nodes] > 0) && ++found == k) {
        long double high = above;
        for (int step = 0; step < 70; ++step) {
          const long double middle = (high + below) / 2;
          if ((polynomials(high)[Nodes] > 0) != (polynomials(middle)[Nodes] > 0)) {
            below = middle;
          } else {
            high = middle;
          }
        }
        return (high + below) / 2;
      }
      above = below;
    }
    return 0;
  }
};

/// Of any way to it.
template <class S, int N> struct FlowArc {
  Vector<S, N> end;
  Vector<S, N> mean;
  bool to_round_off = false;
};

namespace detail {

inline constexpr int gauss_nodes = 8;
inline constexpr GaussNodes<gauss_nodes> gauss{};

/// Takes x where it is larger, or no number.
inline void raise(double& largest, double x) {
  if (!(x <= largest)) largest = x;
}
/// The largest number that a scalar is made of: its value, its derivatives.
template <class S> double largest_number(const S& x) {
  double largest = 0;
  if constexpr (std::floating_point<S>) {
    raise(largest, std::abs(double(x)));
  } else if constexpr (requires { x.derivative; }) {
    raise(largest, largest_number(x.value));
    raise(largest, largest_number(x.derivative));
  } else if constexpr (requires { S::directions; }) {
    raise(largest, largest_number(x.value));
    for (int i = 0; i < S::directions; ++i) raise(largest, std::abs(x.tangent(i)));
  } else if constexpr (requires { x.mixed(); }) {
    raise(largest, largest_number(x.value));
    for (const double each :
         {x.left().cwiseAbs().maxCoeff(), x.right().cwiseAbs().maxCoeff(), x.mixed().cwiseAbs().maxCoeff()})
      raise(largest, double(each));
  } else {
    raise(largest, largest_number(x.value));
    for (int i = 0; i < S::size; ++i) raise(largest, largest_number(x.gradient(i)));
  }
  return largest;
}

/// One part of length `length`. False where the nodes do not resolve it, value or derivative.
template <class S, int N, class F> bool gauss_part(const F& f, double length, FlowArc<S, N>& arc) {
  constexpr int most_passes = 60;
  constexpr double resolved = 1e-8;  // of the coefficients that come next: the end's error is about their square
  constexpr double rounding = 4e-16;
  const Vector<S, N> start = arc.end;
  std::array<Vector<S, N>, std::size_t(gauss_nodes)> rate;
  rate.fill(f(start));
  double scale = 0;
  for (int c = 0; c < N; ++c) {
    raise(scale, largest_number(start(c)));
    raise(scale, length * largest_number(rate[0](c)));
  }
  double last = INFINITY;
  for (int pass = 0;; ++pass) {
    double change = 0;
    std::array<Vector<S, N>, std::size_t(gauss_nodes)> next;
    for (std::size_t i = 0; i < gauss_nodes; ++i) {
      Vector<S, N> at;
      for (int c = 0; c < N; ++c) {
        S sum = rate[0](c) * gauss.integral[i][0];
        for (std::size_t j = 1; j < gauss_nodes; ++j) sum += rate[j](c) * gauss.integral[i][j];
        at(c) = start(c) + sum * length;
      }
      next[i] = f(at);
      for (int c = 0; c < N; ++c) raise(change, length * largest_number(S(next[i](c) - rate[i](c))));
    }
    rate = next;
    if (change <= rounding * scale || (change <= 100 * rounding * scale && change >= last / 2)) break;
    if (pass == most_passes || !std::isfinite(change)) return false;
    last = change;
  }
  // The largest of two Legendre coefficients of f, from m on.
  const auto coefficients = [&](std::size_t m) {
    double largest = 0;
    for (const std::size_t k : {m, m + 1})
      for (int c = 0; c < N; ++c) {
        S sum = rate[0](c) * (gauss.weight[0] * gauss.legendre[k][0]);
        for (std::size_t j = 1; j < gauss_nodes; ++j) sum += rate[j](c) * (gauss.weight[j] * gauss.legendre[k][j]);
        raise(largest, length * largest_number(sum) * double(2 * k + 1));
      }
    return largest;
  };
  const double last_two = coefficients(gauss_nodes - 2);
  const double two_before = coefficients(gauss_nodes - 4);
  if (!(last_two * last_two <= resolved * scale * two_before) && !(last_two <= rounding * scale)) return false;
  for (int c = 0; c < N; ++c) {
    S sum = rate[0](c) * gauss.weight[0];
    // int_0^1 (1 - t) f(y(t)) dt: the mean of y - y(0).
    S moment = rate[0](c) * (gauss.weight[0] * (1 - gauss.node[0]));
    for (std::size_t j = 1; j < gauss_nodes; ++j) {
      sum += rate[j](c) * gauss.weight[j];
      moment += rate[j](c) * (gauss.weight[j] * (1 - gauss.node[j]));
    }
    arc.mean(c) += (start(c) + moment * length) * length;
    arc.end(c) += sum * length;
  }
  return true;
}

/// part(length, arc) takes the arc further; the unit is cut into more parts until all of them can be taken.
template <class S, int N, class Part> FlowArc<S, N> arc_in_parts(const Vector<S, N>& start, const Part& part) {
  constexpr int most_parts = 64;
  FlowArc<S, N> arc;
  for (int parts = 1; parts <= most_parts; parts *= 2) {
    arc.end = start;
    for (int c = 0; c < N; ++c) arc.mean(c) = S(0.0);
    int done = 0;
    while (done < parts && part(1.0 / parts, arc)) ++done;
    arc.to_round_off = done == parts;
    if (arc.to_round_off) break;
  }
  return arc;
}

}  // namespace detail

template <class S, int N, class F> FlowArc<S, N> gauss_arc(const F& f, const Vector<S, N>& start) {
  return detail::arc_in_parts<S, N>(
      start, [&](double length, FlowArc<S, N>& arc) { return detail::gauss_part(f, length, arc); });
}

}  // namespace lagroid
