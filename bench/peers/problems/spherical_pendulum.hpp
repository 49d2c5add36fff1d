#pragma once
/// The spherical pendulum, away from its poles.

#include "problem.hpp"

namespace peers {

/// Unit mass, length and gravity. The equations of the rod are differentiated twice: q'' = -e3 + s q with
/// s = (q3 - |p|^2) / |q|^2. Error: |(q, p) - (q*, p*)|. Invariants: energy, vertical angular momentum, |q|, q.p.
struct SphericalPendulumProblem {
  static constexpr int unknowns = 6;
  static constexpr int compared = 6;
  static constexpr int invariants = 4;

  static std::array<double, 6> start() { return {0.8, 0, -0.6, 0, 0.7, 0}; }
  static double unit() { return 1; }

  template <class S> void operator()(const std::array<S, 6>& y, std::array<S, 6>& dy) const {
    const S s = (y[2] - (y[3] * y[3] + y[4] * y[4] + y[5] * y[5])) / (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    dy = {y[3], y[4], y[5], s * y[0], s * y[1], s * y[2] - 1};
  }
  /// To |q| = 1 and q.p = 0, along q.
  template <class S> void project(std::array<S, 6>& y) const {
    using std::sqrt;
    const S scale = 1 / sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    for (std::size_t i = 0; i < 3; ++i) y[i] *= scale;
    const S along = y[0] * y[3] + y[1] * y[4] + y[2] * y[5];
    for (std::size_t i = 0; i < 3; ++i) y[i + 3] -= along * y[i];
  }

  template <class S> static std::array<S, 6> coordinates(const std::array<S, 6>& y) { return y; }
  template <class S> static S distance(const std::array<S, 6>& a, const std::array<S, 6>& b) {
    return distance_over(a, b, 0, 6);
  }
  template <class S> static std::array<S, 4> kept(const std::array<S, 6>& c) {
    using std::sqrt;
    return {(c[3] * c[3] + c[4] * c[4] + c[5] * c[5]) / 2 + c[2], c[0] * c[4] - c[1] * c[3],
            sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), c[0] * c[3] + c[1] * c[4] + c[2] * c[5]};
  }
};

}  // namespace peers
