#pragma once
/// SO(N), N at run time, as the alpha-fibre of any of its elements.

#include <lagroid/core/alpha_fibre.hpp>
#include <lagroid/groupoids/rotations.hpp>

namespace lagroid {

/// O(N) around a rotation or reflection z, y = z exp(v): the component of z. Coordinates are the entries of a
/// skew-symmetric matrix above its diagonal (`skew`).
class RotationFibre {
 public:
  using Point = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  explicit RotationFibre(Point z) : z_(std::move(z)) {}

  Eigen::Index size() const { return z_.rows(); }
  Eigen::Index dimension() const { return size() * (size() - 1) / 2; }
  const Point& centre() const { return z_; }
  Point at(const Vector& v) const { return z_ * SkewSpectrum(skew(v, size())).exp(); }
  std::optional<Vector> coordinates(const Point& y) const;
  Point moved(const Point& y, const Vector& u) const { return y * SkewSpectrum(skew(u, size())).exp(); }
  Matrix dtau(const Vector& v) const;
  Matrix dtau_inverse(const Vector& v) const;
  /// The spectral norm of the matrix.
  double norm(const Vector& v) const { return SkewSpectrum(skew(v, size())).radius(); }

 private:
  Point z_;
};

}  // namespace lagroid
