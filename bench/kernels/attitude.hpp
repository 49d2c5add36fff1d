#pragma once
/// A rotation matrix that is turned at every step.

#include <Eigen/Core>

namespace kernels {

/// A in SO(3), its columns padded to four numbers: one vector register each.
class Attitude {
 public:
  explicit Attitude(const Eigen::Matrix3d& a) { a_.topRows<3>() = a; }

  Eigen::Matrix3d matrix() const { return a_.topRows<3>(); }

  /// A <- A g, brought back to SO(3) by one Newton-Schulz step A <- A (3 I - A^T A) / 2 = (3 I - A A^T) A / 2.
  void turn(const Eigen::Matrix3d& g) {
    const Padded b = product(a_, g);
    const Padded square = product(b, b.topRows<3>().transpose());
    a_ = 1.5 * b - 0.5 * product(square, b.topRows<3>());
  }

 private:
  using Padded = Eigen::Matrix<double, 4, 3>;

  template <class Derived> static Padded product(const Padded& a, const Eigen::MatrixBase<Derived>& g) {
    Padded out;
    for (int j = 0; j < 3; ++j) out.col(j) = a.col(0) * g(0, j) + a.col(1) * g(1, j) + a.col(2) * g(2, j);
    return out;
  }

  Padded a_ = Padded::Zero();
};

}  // namespace kernels
