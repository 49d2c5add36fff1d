#pragma once
/// SO(N), N known at run time, as the source fibre y = z exp(v) of any of its elements.
///
/// Newton's method for equations on rotations of any dimension works in these coordinates.
///
///     const RotationFibre<> fibre(Eigen::MatrixXd::Identity(5, 5));
///     const auto y = fibre.at(v);           // 10 coordinates: entries above the diagonal
///     const auto back = fibre.coordinates(y);  // a std::optional
///
/// Errors: std::invalid_argument where z is not orthogonal, by more than 1e-6. `coordinates` returns nothing where y is
/// not finite or lies in the other component.

#include <lagroid/core/source_fibre.hpp>
#include <lagroid/groupoids/groups/rotations.hpp>

namespace lagroid {

/// O(N) around a rotation or reflection z, y = z exp(v): the component of z. Coordinates are the entries of a
/// skew-symmetric matrix above its diagonal (`skew`). Compiled for S = double and long double.
template <class S = double> class RotationFibre {
 public:
  using Point = Eigen::MatrixX<S>;
  using Vector = Eigen::VectorX<S>;
  using Matrix = Eigen::MatrixX<S>;

  /// Requires an orthogonal z; throws std::invalid_argument where z^T z is further than 1e-6 from the identity.
  explicit RotationFibre(Point z);
  RotationFibre around(const Point& y) const { return RotationFibre(y); }

  Eigen::Index size() const { return z_.rows(); }
  Eigen::Index dimension() const { return size() * (size() - 1) / 2; }
  const Point& centre() const { return z_; }
  Point at(const Vector& v) const { return moved(z_, v); }
  std::optional<Vector> coordinates(const Point& y) const;
  /// The orthogonal matrix nearest to y exp(u), to first order: one Newton-Schulz step.
  Point moved(const Point& y, const Vector& u) const {
    const Matrix g = y * spectrum(u).exp();
    return (3 * g - g * (g.transpose() * g)) / 2;
  }
  Matrix dtau(const Vector& v) const { return spectrum(v).dexp_matrix(); }
  Matrix dtau_inverse(const Vector& v) const { return spectrum(v).dexp_inverse_matrix(); }
  /// The matrix of [v, .].
  Matrix ad(const Vector& v) const;
  /// y exp(e u), e the infinitesimal.
  Eigen::MatrixX<Dual<S>> displaced(const Point& y, const Vector& u) const {
    return infinitesimally_moved(y, Matrix(y * skew(u, size())));
  }
  /// The spectral norm of the matrix.
  double norm(const Vector& v) const { return double(spectrum(v).radius()); }

 private:
  SkewSpectrum<S> spectrum(const Vector& v) const { return SkewSpectrum<S>(skew(v, size())); }

  Point z_;
};

}  // namespace lagroid
