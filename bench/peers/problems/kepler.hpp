#pragma once
/// The planar Kepler problem.

#include "problem.hpp"

#include <numbers>

namespace peers {

/// Unit mass and strength, eccentricity 0.6, from the pericentre; period 2 pi. Error: |(q, p) - (q*, p*)|. Invariants:
/// energy, angular momentum, the eccentricity vector.
struct KeplerProblem {
  static constexpr int unknowns = 4;
  static constexpr int compared = 4;
  static constexpr int invariants = 4;

  static std::array<double, 4> start() { return {0.4, 0, 0, 2}; }
  static double unit() { return 0.25; }

  template <class S> void operator()(const std::array<S, 4>& y, std::array<S, 4>& dy) const {
    const auto pull = force(std::array<S, 2>{y[0], y[1]});
    dy = {y[2], y[3], pull[0], pull[1]};
  }
  template <class S> static std::array<S, 2> force(const std::array<S, 2>& q) {
    using std::sqrt;
    const S square = q[0] * q[0] + q[1] * q[1];
    const S factor = -1 / (square * sqrt(square));
    return {factor * q[0], factor * q[1]};
  }

  template <class S> static std::array<S, 4> coordinates(const std::array<S, 4>& y) { return y; }
  template <class S> static S distance(const std::array<S, 4>& a, const std::array<S, 4>& b) {
    return distance_over(a, b, 0, 4);
  }
  template <class S> static std::array<S, 4> kept(const std::array<S, 4>& c) {
    using std::sqrt;
    const S r = sqrt(c[0] * c[0] + c[1] * c[1]);
    const S turning = c[0] * c[3] - c[1] * c[2];
    return {2 * ((c[2] * c[2] + c[3] * c[3]) / 2 - 1 / r), turning, c[3] * turning - c[0] / r,
            -c[2] * turning - c[1] / r};
  }

  /// After a time t, by Kepler's equation E - e sin E = n t, for the start as it is rounded: at the pericentre.
  template <class S> static std::array<S, 4> exact(double t) {
    const auto begin = start();
    const S r = begin[0];
    const S speed = begin[3];
    const S axis = 1 / (2 / r - speed * speed);
    const S e = 1 - r / axis;
    const S rate = 1 / (axis * std::sqrt(axis));
    const S mean = std::fmod(rate * S(t), 2 * std::numbers::pi_v<S>);
    S angle = mean;
    for (int i = 0; i < 50; ++i) angle -= (angle - e * std::sin(angle) - mean) / (1 - e * std::cos(angle));
    const S minor = axis * std::sqrt(1 - e * e);
    const S motion = rate / (1 - e * std::cos(angle));
    return {axis * (std::cos(angle) - e), minor * std::sin(angle), -axis * std::sin(angle) * motion,
            minor * std::cos(angle) * motion};
  }
};

}  // namespace peers
