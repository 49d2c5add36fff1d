#pragma once
/// Newton's method of the tests' own, so that what they compare with shares no solver with the library.

#include <lagroid/core/types.hpp>

#include <Eigen/LU>

#include <cstddef>
#include <functional>

namespace lagroid {

/// Newton's method for F(x) = 0 with a Jacobian by differences.
template <int N>
Vector<double, N> root(const std::function<Vector<double, N>(const Vector<double, N>&)>& f, Vector<double, N> x) {
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Vector<double, N> at = f(x);
    Matrix<double, N, N> jacobian;
    for (int i = 0; i < N; ++i) {
      constexpr double by = 1e-6;
      Vector<double, N> up = x;
      Vector<double, N> down = x;
      up(i) += by;
      down(i) -= by;
      jacobian.col(i) = (f(up) - f(down)) / (2 * by);
    }
    const Vector<double, N> change = jacobian.fullPivLu().solve(at);
    x -= change;
    if (change.norm() < 1e-13 * (1 + x.norm())) break;
  }
  return x;
}

/// The limit of values whose errors have even powers of 1 / N, each at twice as many steps as the one before.
template <class Values> auto extrapolated(Values values) {
  double factor = 4;
  for (std::size_t level = values.size() - 1; level > 0; --level, factor *= 4)
    for (std::size_t i = 0; i < level; ++i) values[i] = values[i + 1] + (values[i + 1] - values[i]) / (factor - 1);
  return values[0];
}

}  // namespace lagroid
