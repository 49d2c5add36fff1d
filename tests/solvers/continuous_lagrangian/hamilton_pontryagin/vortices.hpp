#pragma once
/// Four vortices of the plane.

#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <cmath>
#include <numbers>

namespace lagroid::subjects {

/// Four point vortices of the plane (Kirchhoff): sum G_i (x_i y_i' - y_i x_i') / 2 + sum G_i G_j ln r_ij / (2 pi).
struct Vortices : ContinuousLagrangian<Pair<8>> {
  Vector<double, 4> strength{1, 2, -0.5, 1.5};
  template <class S> S l(const Vector<S, 8>& q, const Vector<S, 8>& v) const {
    using std::log;
    S sum(0.0);
    for (int i = 0; i < 4; ++i) {
      sum += (q(2 * i) * v(2 * i + 1) - q(2 * i + 1) * v(2 * i)) * (0.5 * strength(i));
      for (int j = 0; j < i; ++j) {
        const S x = q(2 * i) - q(2 * j);
        const S y = q(2 * i + 1) - q(2 * j + 1);
        sum += log(x * x + y * y) * (strength(i) * strength(j) / (4 * std::numbers::pi));
      }
    }
    return sum;
  }
};

inline const Vector<double, 8> vortices_start = (Vector<double, 8>() << 1, 0, -1, 0.2, 0.1, 1.3, -0.2, -1.1).finished();

}  // namespace lagroid::subjects
