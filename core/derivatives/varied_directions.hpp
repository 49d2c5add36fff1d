#pragma once
/// Derivatives by the numbers of a point and by members of a system at once, a few directions an evaluation.
///
///     const auto step = [&](const auto& x) { return system.velocity(x); };
///     const auto slope = varied_jacobian<2>(step, Vector<double, 2>(2, 0.5), places.members);  // by x, then by these
///
/// Requires an f that is a template on the scalar and reads the members at these places by `varied`
/// (core/scalars/varied.hpp). Returns, allocated, a column for each number of x and each member. Nothing throws.

#include <lagroid/core/scalars/varied.hpp>

#include <algorithm>
#include <span>

namespace lagroid {

/// How many directions one evaluation takes.
inline constexpr int varied_at_once = 4;
using VariedNumber = Varied<varied_at_once>;

namespace detail {

/// x with component `first + i` of the directions along component i of it.
template <int N> Vector<VariedNumber, N> varied_along(const Vector<double, N>& x, int first) {
  Vector<VariedNumber, N> out;
  for (int i = 0; i < N; ++i)
    out(i) =
        0 <= first + i && first + i < varied_at_once ? VariedNumber::variable(x(i), first + i) : VariedNumber(x(i));
  return out;
}

/// Visits the directions, as many at a time as a number has: visit(first) evaluates those from `first` on.
template <class Visit> void for_directions(int count, const Visit& visit) {
  for (int first = 0; first < count; first += varied_at_once) visit(first);
}

/// Writes the tangents of y into the columns of its directions, from `first` on.
template <class Y, class Out> void put_tangents(const Y& y, int first, Out&& columns) {
  const int count = std::min(varied_at_once, int(columns.cols()) - first);
  for (int i = 0; i < y.size(); ++i)
    for (int k = 0; k < count; ++k) columns(i, first + k) = y(i).tangent(k);
}

}  // namespace detail

/// df, f : R^N -> R^D.
template <int D, int N, class F>
Matrix<double, D, Eigen::Dynamic> varied_jacobian(const F& f, const Vector<double, N>& x,
                                                  std::span<const double* const> members = {}) {
  Matrix<double, D, Eigen::Dynamic> out(D, N + int(members.size()));
  detail::for_directions(int(out.cols()), [&](int first) {
    const VariedMembers varying(members, N - first);
    detail::put_tangents(f(detail::varied_along(x, -first)), first, out);
  });
  return out;
}

}  // namespace lagroid
