#pragma once
/// A heavy symmetric top, spinning fast and nodding.

#include "problem.hpp"
#include "rotation.hpp"

namespace peers {

/// Moments 1, 1, 1/2, weight times lever 1 on the third axis; v = A^T e3 is the vertical seen from the body:
/// M' = M x w + v x e3. Error as of the free body. Invariants: energy, vertical momentum v.M, axial momentum.
struct TopProblem {
  static constexpr int unknowns = 7;
  static constexpr int compared = 12;
  static constexpr int invariants = 3;
  static constexpr std::array<double, 3> momentum{0.4, 0.2, 3};
  static constexpr double tilt = 0.6;  ///< about the first axis

  static std::array<double, 7> start() {
    return {std::cos(tilt / 2), std::sin(tilt / 2), 0, 0, momentum[0], momentum[1], momentum[2]};
  }
  static double unit() { return 0.5; }

  /// |q| is constant, and v is the vertical times |q|^2.
  template <class S> void operator()(const std::array<S, 7>& y, std::array<S, 7>& dy) const {
    const S w1 = y[4];
    const S w2 = y[5];
    const S w3 = y[6] * 2;
    turn(y, w1, w2, w3, dy);
    dy[4] = y[5] * w3 - y[6] * w2 + 2 * (y[2] * y[3] + y[0] * y[1]);
    dy[5] = y[6] * w1 - y[4] * w3 - 2 * (y[1] * y[3] - y[0] * y[2]);
    dy[6] = 0;
  }

  template <class S> static std::array<S, 12> coordinates(const std::array<S, 7>& y) {
    return attitude_and_momentum(y);
  }
  template <class S> static S distance(const std::array<S, 12>& a, const std::array<S, 12>& b) {
    return distance_over(a, b, 0, 9) + distance_over(a, b, 9, 12);
  }
  template <class S> static std::array<S, 3> kept(const std::array<S, 12>& c) {
    const S energy = (c[9] * c[9] + c[10] * c[10]) / 2 + c[11] * c[11] + c[8];
    return {energy / 9, (c[6] * c[9] + c[7] * c[10] + c[8] * c[11]) / 3, c[11] / 3};
  }
};

}  // namespace peers
