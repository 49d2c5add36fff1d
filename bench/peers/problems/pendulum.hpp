#pragma once
/// The planar pendulum.

#include "problem.hpp"

namespace peers {

/// Unit mass, length and gravity, let go at two radians. Error: |(q, p) - (q*, p*)|. Invariant: energy.
struct PendulumProblem {
  static constexpr int unknowns = 2;
  static constexpr int compared = 2;
  static constexpr int invariants = 1;

  static std::array<double, 2> start() { return {2, 0}; }
  static double unit() { return 1; }

  template <class S> void operator()(const std::array<S, 2>& y, std::array<S, 2>& dy) const {
    using std::sin;
    dy = {y[1], -sin(y[0])};
  }
  template <class S> static std::array<S, 1> force(const std::array<S, 1>& q) {
    using std::sin;
    return {-sin(q[0])};
  }

  template <class S> static std::array<S, 2> coordinates(const std::array<S, 2>& y) { return y; }
  template <class S> static S distance(const std::array<S, 2>& a, const std::array<S, 2>& b) {
    return distance_over(a, b, 0, 2);
  }
  template <class S> static std::array<S, 1> kept(const std::array<S, 2>& c) {
    using std::cos;
    return {c[1] * c[1] / 2 - cos(c[0])};
  }
};

}  // namespace peers
