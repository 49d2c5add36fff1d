#pragma once
/// The free rigid body near its middle axis.

#include "problem.hpp"
#include "rotation.hpp"

namespace peers {

/// Moments 1, 2, 3. Error: |M - M*| + |A - A*|, the latter over all nine components. Invariants: energy and A M.
struct RigidBodyProblem {
  static constexpr int unknowns = 7;
  static constexpr int compared = 12;
  static constexpr int invariants = 4;
  static constexpr std::array<double, 3> momentum{0.2, 1.98, 0.1};

  static std::array<double, 7> start() { return {1, 0, 0, 0, momentum[0], momentum[1], momentum[2]}; }
  static double unit() { return 1; }

  template <class S> void operator()(const std::array<S, 7>& y, std::array<S, 7>& dy) const {
    const S w1 = y[4];
    const S w2 = y[5] * S(0.5);
    const S w3 = y[6] * (S(1) / 3);
    turn(y, w1, w2, w3, dy);
    dy[4] = y[5] * w3 - y[6] * w2;
    dy[5] = y[6] * w1 - y[4] * w3;
    dy[6] = y[4] * w2 - y[5] * w1;
  }

  template <class S> static std::array<S, 12> coordinates(const std::array<S, 7>& y) {
    return attitude_and_momentum(y);
  }
  template <class S> static S distance(const std::array<S, 12>& a, const std::array<S, 12>& b) {
    return distance_over(a, b, 0, 9) + distance_over(a, b, 9, 12);
  }
  template <class S> static std::array<S, 4> kept(const std::array<S, 12>& c) {
    std::array<S, 4> out{c[9] * c[9] / 2 + c[10] * c[10] / 4 + c[11] * c[11] / 6};
    for (std::size_t i = 0; i < 3; ++i)
      out[i + 1] = (c[3 * i] * c[9] + c[3 * i + 1] * c[10] + c[3 * i + 2] * c[11]) / 2;
    return out;
  }
};

}  // namespace peers
