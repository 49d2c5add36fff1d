#pragma once
/// Bodies that turn, as right-hand sides of seven unknowns: quaternion (w, x, y, z) of the attitude, body momentum.

#include <array>
#include <cmath>

namespace peers {

/// q' = q (0, w) / 2.
template <class S> void turn(const std::array<S, 7>& y, S w1, S w2, S w3, std::array<S, 7>& dy) {
  const S a = w1 * S(0.5);
  const S b = w2 * S(0.5);
  const S c = w3 * S(0.5);
  dy[0] = -y[1] * a - y[2] * b - y[3] * c;
  dy[1] = y[0] * a + y[2] * c - y[3] * b;
  dy[2] = y[0] * b + y[3] * a - y[1] * c;
  dy[3] = y[0] * c + y[1] * b - y[2] * a;
}

/// The attitude A by rows, which carries body to space, and the momentum. The quaternion need not have length one.
template <class S> std::array<S, 12> attitude_and_momentum(const std::array<S, 7>& y) {
  const auto [w, x, y2, z, m1, m2, m3] = y;
  const S scale = 2 / (w * w + x * x + y2 * y2 + z * z);
  return {1 - scale * (y2 * y2 + z * z),
          scale * (x * y2 - w * z),
          scale * (x * z + w * y2),
          scale * (x * y2 + w * z),
          1 - scale * (x * x + z * z),
          scale * (y2 * z - w * x),
          scale * (x * z - w * y2),
          scale * (y2 * z + w * x),
          1 - scale * (x * x + y2 * y2),
          m1,
          m2,
          m3};
}

}  // namespace peers
