#pragma once
/// Increments of Wiener processes that are functions of seed, path and step: nothing is carried from one to the next,
/// so that they are the same on any number of threads and ranks, in any order, and after a resume.
///
///     dW = sqrt(h) xi,    xi normal, and cut at +-A,    A^2 = 8 max(4, |ln h|),
///
/// xi by the transformation of Box and Muller from Philox4x32-10, whose key is the seed and whose counter is (step,
/// path, number of the process). Implicit steps need increments that are bounded; cut there, weak order 1 and strong
/// orders up to 1 stay.
///
///     const WienerPath wiener{.seed = 1, .path = 7};
///     const Vector<double, 3> dw = wiener.increments<3>(1000, 0.01);  // of the step from t = 10 to t = 10.01
///
/// Requires h > 0 and a step >= 0. Nothing throws, nothing is allocated.
///
/// Source: Salmon, Moraes, Dror, Shaw, Parallel random numbers: as easy as 1, 2, 3, SC 2011 (the generator); Milstein,
/// Repin, Tretyakov, SIAM J. Numer. Anal. 40, 2002 (the cut).

#include <lagroid/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace lagroid {

struct WienerPath {
  std::uint64_t seed = 1;
  std::uint32_t path = 0;

  /// Two independent normal numbers, those of processes 2 `pair` and 2 `pair` + 1.
  std::array<double, 2> normals(std::int64_t step, std::uint32_t pair) const;

  /// Those of N independent processes over a step of size h, cut.
  template <int N> Vector<double, N> increments(std::int64_t step, double h) const {
    const double size = std::sqrt(h);
    Vector<double, N> dw;
    for (int k = 0; k < N; k += 2) {
      const std::array<double, 2> xi = normals(step, std::uint32_t(k / 2));
      for (int i = k; i < std::min(k + 2, N); ++i) dw(i) = cut(size * xi[std::size_t(i - k)], h);
    }
    return dw;
  }
  /// An increment over h, cut at sqrt(h) A.
  static double cut(double dw, double h) {
    const double most = std::sqrt(8 * h * std::max(4.0, std::abs(std::log(h))));
    return std::clamp(dw, -most, most);
  }
};

}  // namespace lagroid
