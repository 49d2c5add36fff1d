#pragma once
/// GL(n) and SL(n), n known at run time, as the source fibre y = z exp(v) of any of their elements.
///
/// Newton's method for equations on matrices, of any size, works in these coordinates.
///
///     const LinearFibre fibre(Eigen::MatrixXd::Identity(5, 5), LinearFibre::Determinant::any);
///     const auto y = fibre.at(v);           // 25 coordinates
///     const auto back = fibre.coordinates(y);  // a std::optional
///
/// Requires an invertible z. `coordinates` returns nothing where z^{-1} y has no principal logarithm or, on SL(n),
/// another determinant. Nothing throws.

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/source_fibre.hpp>

namespace lagroid {

/// The matrices y = z exp(v). Coordinates: the entries of v by columns; for SL(n) without the last one, which makes the
/// trace zero. exp is not onto: `coordinates` has nothing for y where z^{-1} y has an eigenvalue on the closed negative
/// real axis, and then no principal logarithm, nor on SL(n) where the determinants of y and z differ. Differentials
/// take n^2 exponentials of 2n x 2n matrices.
class LinearFibre {
 public:
  using Point = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  enum class Determinant { any, kept };  ///< GL(n); SL(n), or any coset of it

  LinearFibre(Point z, Determinant determinant) : z_(std::move(z)), determinant_(determinant) {}
  LinearFibre around(const Point& y) const { return {y, determinant_}; }

  Eigen::Index size() const { return z_.rows(); }
  Eigen::Index dimension() const { return size() * size() - (determinant_ == Determinant::kept ? 1 : 0); }
  const Point& centre() const { return z_; }
  Point at(const Vector& v) const { return moved(z_, v); }
  std::optional<Vector> coordinates(const Point& y) const;
  Point moved(const Point& y, const Vector& u) const;
  Matrix dtau(const Vector& v) const;
  Matrix dtau_inverse(const Vector& v) const { return inverse_of(dtau(v)); }
  /// The matrix of [v, .].
  Matrix ad(const Vector& v) const;
  /// The Euclidean norm of the coordinates.
  double norm(const Vector& v) const { return v.norm(); }
  /// The matrix with the coordinates v.
  Matrix hat(const Vector& v) const;
  /// y exp(e u), e the infinitesimal.
  Eigen::MatrixX<Dual<double>> displaced(const Point& y, const Vector& u) const {
    return infinitesimally_moved(y, Matrix(y * hat(u)));
  }

 private:
  Vector vee(const Matrix& x) const { return x.reshaped().head(dimension()); }
  /// The matrix of a linear map of the algebra.
  template <class Map> Matrix matrix_of(const Map& map) const {
    Matrix out(dimension(), dimension());
    for (Eigen::Index i = 0; i < dimension(); ++i) out.col(i) = vee(map(hat(Vector::Unit(dimension(), i))));
    return out;
  }

  Point z_;
  Determinant determinant_;
};

}  // namespace lagroid
