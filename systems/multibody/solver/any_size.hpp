#pragma once
/// Norms of vectors and inverses of matrices whose squares or determinants overflow or underflow.

#include <lagroid/systems/multibody/configuration.hpp>

#include <Eigen/LU>

namespace lagroid::multibody {

/// |v|, also where squares overflow or underflow.
LAGROID_INLINE inline double size_of(const Vec& v) {
  const double largest = v.lpNorm<Eigen::Infinity>();
  return largest == 0 || (largest > 1e-150 && largest < 1e150) ? v.norm() : v.stableNorm();
}

/// The inverse, also where the determinant overflows or underflows.
inline Mat inverse(const Mat& a) {
  const double size = a.lpNorm<Eigen::Infinity>();
  if (size > 1e-90 && size < 1e90) return a.inverse();
  return Mat(a / size).inverse() / size;
}

}  // namespace lagroid::multibody
