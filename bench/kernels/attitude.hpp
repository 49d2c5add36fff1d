#pragma once
/// A rotation matrix that is turned at every step.

#include "vectors.hpp"

namespace kernels {

/// A in SO(3), its columns padded to four numbers: one vector register each.
class Attitude {
 public:
  explicit Attitude(const Eigen::Matrix3d& a) {
    for (int j = 0; j < 3; ++j) column_[j] = Column{a(0, j), a(1, j), a(2, j), 0};
  }

  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d a;
    for (int j = 0; j < 3; ++j) a.col(j) << column_[j][0], column_[j][1], column_[j][2];
    return a;
  }

  /// A <- A g with g = c I + hat(w) + d w w^T (every rotation about w has this form), brought back to SO(3) by one
  /// Newton-Schulz step A <- A (3 I - A^T A) / 2 = (3 I - A A^T) A / 2.
  void turn(Triple w, double c, double d) {
    const Triple z = d * w;
    Column turned[3];
    combine(column_, c + z.x * w.x, z.x * w.y + w.z, z.x * w.z - w.y, turned[0]);
    combine(column_, z.x * w.y - w.z, c + z.y * w.y, z.y * w.z + w.x, turned[1]);
    combine(column_, z.x * w.z + w.y, z.y * w.z - w.x, c + z.z * w.z, turned[2]);
    Column square[3];
    for (int j = 0; j < 3; ++j) combine(turned, turned[0][j], turned[1][j], turned[2][j], square[j]);
    for (int j = 0; j < 3; ++j) {
      combine(square, turned[j][0], turned[j][1], turned[j][2], column_[j]);
      column_[j] = 1.5 * turned[j] - 0.5 * column_[j];
    }
  }

 private:
  using Column = double __attribute__((vector_size(4 * sizeof(double))));

  static void combine(const Column (&a)[3], double x, double y, double z, Column& out) {
    out = a[0] * x + a[1] * y + a[2] * z;
  }

  Column column_[3];
};

}  // namespace kernels
