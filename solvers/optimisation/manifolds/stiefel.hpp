#pragma once
/// The Stiefel manifold St(m, n) = {X in R^(n x m), X^T X = I}, and with m = n the orthogonal group; tangent projection
/// P_X Z = Z - X sym(X^T Z). Eigenvectors and best rotations are minima on it. Sizes other than 1 <= m <= n throw
/// std::invalid_argument. [V] 5.3.2

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <Eigen/QR>

namespace lagroid::optimisation {

/// St(m, n), the n x m matrices with X^T X = I ([V] 5.3.2), m <= n; O(n) for m = n. C(X) = (X^T X - I) / 2. Tangent
/// vectors are V with X^T V skew, P_X Z = Z - X sym(X^T Z).
///
/// Curvature: K(U, V) = Trace(U^T U V^T V) - |sym(U^T V)|^2 by Gauss' equation; 1 for m = 1, at least 0 for m = n, else
/// at least -1/2, which U = b e_1^T, V = b e_2^T attain (D. Nguyen, Curvatures of Stiefel manifolds with deformation
/// metrics, 2021). Any two points are joined by a curve of length pi sqrt(m) (in one component, for m = n).
///
/// The work of each operation is a few products of n x m with m x m matrices; none is of the size n x n for m < n.
class Stiefel final : public Manifold {
 public:
  /// Throws std::invalid_argument unless 1 <= m <= n.
  Stiefel(Eigen::Index n, Eigen::Index m);

  Eigen::Index rows() const { return n_; }
  Eigen::Index columns() const { return m_; }

  std::string name() const override;
  Eigen::Index size() const override { return n_ * m_; }
  Eigen::Index dimension() const override { return n_ * m_ - m_ * (m_ + 1) / 2; }
  double residual(const Point& x) const override;
  double penalty(const Point& x, double weight, Vector& gradient) const override;
  /// The polar factor. False where x has no full rank.
  bool nearest(Point& x) const override;
  void project(const Point& x, Vector& v) const override;
  bool offers(ManifoldRetraction) const override { return true; }
  bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const override;
  /// X+ = X (S + W) + B with W = skew(X^T Z), B = Z - X X^T Z and S symmetric positive,
  /// S^2 + S W + W^T S = I - B^T B - W^T W: by T <- -(B^T B + W^T W + T^2 + T W + W^T T) / 2, S = I + T, from T = 0,
  /// and where that is slow by Newton's method, a Lyapunov equation each time. The multipliers are lambda = -T (up to
  /// the symmetric part of X^T Z). One Newton-Schulz step X <- X (3 I - X^T X) / 2 keeps X^T X = I to round-off.
  bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const override;
  double reach(const Vector& v) const override;
  /// Known for m = n: X log(X^T Y). False for m < n, in the other component and at half turns.
  bool logarithm(const Point& x, const Point& y, Vector& v) const override;
  /// Where the logarithm is known: X R (X^T V) R, R^2 = X^T Y.
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override;
  /// P_X(h - V sym(X^T G)).
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override;
  double least_curvature() const override;
  double diameter() const override;

 private:
  using Matrix = Eigen::MatrixXd;

  /// gram_ = a^T a.
  void gram_of(const Eigen::Ref<const Matrix>& a) const;
  bool qr(Matrix& y) const;
  bool multipliers() const;
  void polish(Point& x) const;

  Eigen::Index n_;
  Eigen::Index m_;
  mutable Eigen::HouseholderQR<Matrix> factorisation_;
  mutable Matrix tall_;                                     ///< n x m
  mutable Matrix product_, skew_, gram_, normal_, square_;  ///< m x m: X^T Z, W, B^T B + W^T W, T, scratch
  mutable Vector moved_;
};

/// The sign of det X: 1 or -1, the component of O(n) in which X lies. A method that steps along retractions never
/// leaves it.
int component(const Eigen::Ref<const Eigen::MatrixXd>& x);

}  // namespace lagroid::optimisation
