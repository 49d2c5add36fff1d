#pragma once
/// Newton's versions 1 and 2 for an implicit Euler step on SO(3), by hand with Rodrigues' formula.

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

namespace kernels {

/// y = z exp(h hat(g(y))) with g of [N] example 1: hat(g) has the entries of y beside the diagonal, so that
/// g = (-y_12, 0, -y_01).
class RodriguesNewton {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  static Vector g(const Matrix& y) { return {-y(1, 2), 0, -y(0, 1)}; }
  /// The rows of y hat(w) are y_r x w.
  static Matrix dg(const Matrix& y) {
    Matrix m;
    m << y(1, 1), -y(1, 0), 0, 0, 0, 0, -y(0, 2), 0, y(0, 0);
    return m;
  }

  /// Newton's iteration on the group; the number of iterations, -1 where they do not end.
  static int version1(const Matrix& z, double h, Matrix& y) {
    y = z;
    Vector v = Vector::Zero();
    for (int k = 0; k < limit; ++k) {
      const Vector f = v - h * g(y);
      if (f.norm() <= tolerance) return k;
      y = y * exp(-solve(dexp_inverse(v) - h * dg(y), f));
      v = log(z.transpose() * y);
    }
    return -1;
  }
  /// The same in the algebra.
  static int version2(const Matrix& z, double h, Matrix& y) {
    y = z;
    Vector v = Vector::Zero();
    for (int k = 0; k < limit; ++k) {
      const Vector f = v - h * g(y);
      if (f.norm() <= tolerance) return k;
      v -= solve(Matrix::Identity() - h * (dg(y) * dexp(v)), f);
      y = z * exp(v);
    }
    return -1;
  }

 private:
  static constexpr int limit = 100;
  static constexpr double tolerance = 1e-13;

  static Matrix hat(const Vector& w) {
    Matrix m;
    m << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
    return m;
  }
  static Matrix exp(const Vector& w) {
    const double square = w.squaredNorm();
    const double angle = std::sqrt(square);
    const double half = std::sin(0.5 * angle);
    const double a = angle < 1e-4 ? 1 - square / 6 : std::sin(angle) / angle;
    const double b = angle < 1e-4 ? 0.5 - square / 24 : 2 * half * half / square;
    const double xx = b * w(0) * w(0);
    const double yy = b * w(1) * w(1);
    const double zz = b * w(2) * w(2);
    const double xy = b * w(0) * w(1);
    const double xz = b * w(0) * w(2);
    const double yz = b * w(1) * w(2);
    const Vector u = a * w;
    Matrix r;
    r << 1 - yy - zz, xy - u(2), xz + u(1), xy + u(2), 1 - xx - zz, yz - u(0), xz - u(1), yz + u(0), 1 - xx - yy;
    return r;
  }
  /// For angles that are not near pi.
  static Vector log(const Matrix& r) {
    const Vector twice(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    const double sine = 0.5 * twice.norm();
    const double angle = std::atan2(sine, 0.5 * (r.trace() - 1));
    return twice * (sine < 1e-4 ? 0.5 + angle * angle / 12 : 0.5 * angle / sine);
  }
  static Matrix dexp(const Vector& w) {
    const double square = w.squaredNorm();
    const double angle = std::sqrt(square);
    const double half = std::sin(0.5 * angle);
    const double a = angle < 1e-4 ? 0.5 - square / 24 : 2 * half * half / square;
    const double b = angle < 1e-4 ? 1.0 / 6 - square / 120 : (angle - std::sin(angle)) / (square * angle);
    const Matrix m = hat(w);
    return Matrix::Identity() - a * m + b * (m * m);
  }
  static Matrix dexp_inverse(const Vector& w) {
    const double square = w.squaredNorm();
    const double half = 0.5 * std::sqrt(square);
    const double c = half < 1e-4 ? 1.0 / 12 + square / 720 : (1 - half / std::tan(half)) / square;
    const Matrix m = hat(w);
    return Matrix::Identity() + 0.5 * m + c * (m * m);
  }
  /// Cramer's rule.
  static Vector solve(const Matrix& m, const Vector& f) {
    const Vector a = m.col(0);
    const Vector b = m.col(1);
    const Vector c = m.col(2);
    const Vector bc = b.cross(c);
    return Vector(f.dot(bc), f.dot(c.cross(a)), f.dot(a.cross(b))) / a.dot(bc);
  }
};

}  // namespace kernels
