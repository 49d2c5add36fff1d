#pragma once
/// Vectors of the plane and of space as plain numbers: the compiler keeps them in scalar registers, which for code of
/// this size beats packing three numbers into a vector register and unpacking them again.

#include <Eigen/Core>

namespace kernels {

struct Pair {
  double x = 0;
  double y = 0;

  Pair() = default;
  constexpr Pair(double a, double b) : x(a), y(b) {}
  explicit Pair(const Eigen::Vector2d& v) : x(v(0)), y(v(1)) {}
  Eigen::Vector2d vector() const { return {x, y}; }

  friend Pair operator+(Pair a, Pair b) { return {a.x + b.x, a.y + b.y}; }
  friend Pair operator-(Pair a, Pair b) { return {a.x - b.x, a.y - b.y}; }
  friend Pair operator*(double s, Pair a) { return {s * a.x, s * a.y}; }
  friend double dot(Pair a, Pair b) { return a.x * b.x + a.y * b.y; }
};

struct Triple {
  double x = 0;
  double y = 0;
  double z = 0;

  Triple() = default;
  constexpr Triple(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit Triple(const Eigen::Vector3d& v) : x(v(0)), y(v(1)), z(v(2)) {}
  Eigen::Vector3d vector() const { return {x, y, z}; }

  friend Triple operator+(Triple a, Triple b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Triple operator-(Triple a, Triple b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Triple operator*(double s, Triple a) { return {s * a.x, s * a.y, s * a.z}; }
  friend double dot(Triple a, Triple b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Triple cross(Triple a, Triple b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  /// diag(a) b.
  friend Triple scaled(Triple a, Triple b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
};

}  // namespace kernels
