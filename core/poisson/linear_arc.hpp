#pragma once
/// The solution of y' = A y over a unit of time and its mean, to round-off, by their power series: what a frozen
/// momentum does on the dual of a Lie algebra.
///
///     const auto turn = [](const auto& y) { return Vector<double, 2>(-y(1), y(0)); };
///     const auto arc = linear_arc(turn, Vector<double, 2>(1, 0));  // arc.end = (cos 1, sin 1)
///
/// Requires a linear f : Vector<S, N> -> Vector<S, N>. Returns the end, the mean over the arc, and whether both are
/// known to round-off: the unit is cut into parts until terms fall from the first on, at most 64. An arc of a nilpotent
/// A has as many terms as it takes. Nothing is allocated, nothing throws.

#include <lagroid/core/poisson/gauss_collocation.hpp>

#include <limits>

namespace lagroid {

namespace detail {

/// One part of length `length`; false where the series does not fall from its first terms on. Each number is summed
/// until its own terms do not matter: small ones may be all that a bracket is made of.
template <class S, int N, class F> bool linear_part(const F& f, double length, FlowArc<S, N>& arc) {
  constexpr int most_terms = 30;
  constexpr double rounding = 0.5 * std::numeric_limits<double>::epsilon();
  Vector<S, N> term = arc.end;
  Vector<S, N> mean = arc.end;
  double scale = 0;
  for (int c = 0; c < N; ++c) raise(scale, largest_number(term(c)));
  double size = scale;
  bool ends = false;
  for (int k = 1; k <= most_terms; ++k) {
    const Vector<S, N> next = f(term);
    size = 0;
    ends = true;
    for (int c = 0; c < N; ++c) {
      term(c) = next(c) * (length / k);
      arc.end(c) += term(c);
      mean(c) += term(c) * (1.0 / (k + 1));
      const double of_term = largest_number(term(c));
      raise(size, of_term);
      ends = ends && of_term <= rounding * largest_number(arc.end(c));
    }
    if (k == 1) raise(scale, size);
    if (ends) break;
    if (!(size <= 2 * scale)) return false;
  }
  for (int c = 0; c < N; ++c) arc.mean(c) += mean(c) * length;
  return ends || size <= rounding * scale;
}

}  // namespace detail

template <class S, int N, class F> FlowArc<S, N> linear_arc(const F& f, const Vector<S, N>& start) {
  return detail::arc_in_parts<S, N>(
      start, [&](double length, FlowArc<S, N>& arc) { return detail::linear_part(f, length, arc); });
}

}  // namespace lagroid
