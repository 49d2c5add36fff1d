#pragma once
/// The symmetric positive definite matrices P(n) with the metric that no change of basis X -> A X A^T alters:
///
///     <U, V>_X = Trace(X^-1 U X^-1 V),    exp_X(V) = L exp(L^-1 V L^-T) L^T,   X = L L^T.
///
/// Covariances, diffusion tensors and stiffnesses lie there; between two of them a straight line swells, a geodesic
/// does not.
///
///     const optimisation::PositiveDefinite ellipses(2);
///     const Eigen::Vector4d x(1, 0, 0, 1), y(4, 0, 0, 9);  // matrices by columns
///     optimisation::Vector v;
///     ellipses.logarithm(x, y, v);  // (log 4, 0, 0, log 9)
///
/// n < 1 throws std::invalid_argument. (R. Bhatia, Positive Definite Matrices, 2007, chapter 6.)

#include <lagroid/solvers/optimisation/manifolds/hadamard.hpp>

#include <Eigen/Cholesky>

namespace lagroid::optimisation {

/// P(n), an open part of the symmetric matrices, in the space E of all n x n matrices. Geodesics are unique, all of
/// them; curvatures lie between -1/2 and 0 (n > 1). Distances are those of the eigenvalues of X^-1 Y,
/// d(X, Y)^2 = sum log^2 lambda_i; of nearby matrices those of X^-1 (Y - X), which do not cancel.
///
/// The factor L of the last X is kept: what is asked at one point, one after another, factorises once.
class PositiveDefinite final : public HadamardManifold {
 public:
  /// Throws std::invalid_argument for n < 1.
  explicit PositiveDefinite(Eigen::Index n);

  Eigen::Index rows() const { return n_; }

  std::string name() const override;
  Eigen::Index size() const override { return n_ * n_; }
  Eigen::Index dimension() const override { return n_ * (n_ + 1) / 2; }
  /// C(X) = (X - X^T) / 2; infinite where X is not positive definite.
  double residual(const Point& x) const override;
  double penalty(const Point& x, double weight, Vector& gradient) const override;
  /// The symmetric part. False where it is not positive definite: P(n) is open, and has no nearest point.
  bool nearest(Point& x) const override;
  void project(const Point& x, Vector& v) const override;

  double inner(const Point& x, const Vector& u, const Vector& v) const override;
  /// X sym(G) X.
  void gradient(const Point& x, Vector& differential) const override;
  void differential(const Point& x, Vector& gradient) const override;

  bool logarithm(const Point& x, const Point& y, Vector& v) const override;
  /// E V E^T, E = (Y X^-1)^(1/2) = L (L^-1 Y L^-T)^(1/2) L^-1.
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override;
  /// With L^-1 Y L^-T = U exp(s) U^T the entries of (L U)^-1 V (L U)^-T times (s_i - s_j) / (exp s_i - exp s_j): the
  /// derivative of the matrix logarithm (Daleckii and Krein 1965).
  bool logarithm_by_end(const Point& x, const Point& y, Vector& v) const override;
  /// The same entries times -t coth t, t = (s_i - s_j) / 2.
  bool logarithm_by_start(const Point& x, const Point& y, Vector& v) const override;
  /// X sym(h) X + sym(V sym(G) X).
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override;
  double least_curvature() const override { return n_ > 1 ? -0.5 : 0; }

 private:
  bool exponential(const Point& x, const Vector& v, Point& to) const override;

  using Matrix = Eigen::MatrixXd;

  bool factorise(const Point& x) const;
  void reduce(const Vector& v, Matrix& out) const;
  /// s and U with L^-1 Y L^-T = U exp(s) U^T. False where these are no numbers.
  bool logarithms(const Point& x, const Point& y, Eigen::VectorXd& s, Matrix& u) const;
  /// Entries of (L U)^-1 V (L U)^-T times factor(s_i, s_j).
  template <class Factor> bool stretch_entries(const Point& x, const Point& y, const Factor& factor, Vector& v) const;
  void symmetric_part(const Vector& v, Matrix& out) const;

  Eigen::Index n_;
  mutable Point factorised_;
  mutable bool positive_ = false;
  mutable Eigen::LLT<Matrix> factor_;
  mutable Matrix one_, other_, product_;  ///< scratch
};

}  // namespace lagroid::optimisation
