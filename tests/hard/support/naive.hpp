#pragma once
/// The naive ways: explicit methods, plain sums.

#include <Eigen/Core>

#include <functional>

namespace lagroid::hard {

/// y' = f(y).
using Field = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

inline Eigen::VectorXd euler_step(const Field& f, const Eigen::VectorXd& y, double h) { return y + h * f(y); }

/// The classical method of Runge and Kutta, of order four.
inline Eigen::VectorXd runge_kutta_step(const Field& f, const Eigen::VectorXd& y, double h) {
  const Eigen::VectorXd a = f(y);
  const Eigen::VectorXd b = f(y + 0.5 * h * a);
  const Eigen::VectorXd c = f(y + 0.5 * h * b);
  const Eigen::VectorXd d = f(y + h * c);
  return y + h / 6 * (a + 2 * b + 2 * c + d);
}

/// M' = M x I^{-1} M, with A' = A hat(I^{-1} M) behind it: 3 + 9 numbers.
inline Field free_body(const Eigen::Vector3d& inertia) {
  return [inertia](const Eigen::VectorXd& y) {
    const Eigen::Vector3d m = y.head<3>();
    const Eigen::Vector3d w = m.cwiseQuotient(inertia);
    Eigen::VectorXd out(12);
    out.head<3>() = m.cross(w);
    const Eigen::Matrix3d a = y.tail<9>().reshaped(3, 3);
    Eigen::Matrix3d turning;
    turning << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
    out.tail<9>() = (a * turning).reshaped();
    return out;
  };
}
inline Eigen::VectorXd free_body_state(const Eigen::Vector3d& momentum) {
  Eigen::VectorXd y(12);
  y << momentum, Eigen::Matrix3d::Identity().reshaped();
  return y;
}
/// A M.
inline Eigen::Vector3d spatial_momentum(const Eigen::VectorXd& y) { return y.tail<9>().reshaped(3, 3) * y.head<3>(); }

}  // namespace lagroid::hard
