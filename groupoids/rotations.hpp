#pragma once
/// exp, log and their differentials on SO(N), for N chosen at run time. ([N] section 2.3; the spectral forms are ours.)

#include <Eigen/Core>

#include <optional>

namespace lagroid {

/// The skew-symmetric n x n matrix with the entries x above its diagonal, row by row.
Eigen::MatrixXd skew(const Eigen::VectorXd& x, Eigen::Index n);
/// Back, of the skew-symmetric part of any square matrix.
Eigen::VectorXd skew_entries(const Eigen::MatrixXd& a);

/// A skew-symmetric matrix X = U diag(i w) U^*, U unitary, w real: what its exponential and differentials are made of.
class SkewSpectrum {
 public:
  explicit SkewSpectrum(const Eigen::MatrixXd& x);

  /// exp(X).
  Eigen::MatrixXd exp() const;
  /// dexp_X(Y) = L'_{exp(-X)} exp'_X(Y), exact: in the basis U the entries of Y are multiplied by exp(-i d) sin(d) / d,
  /// d half the difference of their two w ([N] (2.10)).
  Eigen::MatrixXd dexp(const Eigen::MatrixXd& y) const;
  /// dexp_X^{-1}(Y). Requires that no two w differ by a non-zero multiple of 2 pi; entries are not finite there.
  Eigen::MatrixXd dexp_inverse(const Eigen::MatrixXd& y) const;
  /// The largest |w|. Below pi, X is the principal logarithm of exp(X).
  double radius() const { return frequencies_.size() == 0 ? 0 : frequencies_.cwiseAbs().maxCoeff(); }

 private:
  Eigen::MatrixXd multiplied(const Eigen::MatrixXd& y, const Eigen::MatrixXcd& factors) const;
  Eigen::VectorXd frequencies_;
  Eigen::MatrixXcd basis_;
};

/// The principal logarithm of an orthogonal matrix: skew-symmetric, of spectral radius at most pi; nothing where the
/// determinant is -1. Relative accuracy near the identity, where it is 2 artanh((Q + I)^{-1} (Q - I)). Eigenvalues at
/// and near -1 are no exception: each pair is a turn by nearly pi in the plane that the real Schur form finds for it.
std::optional<Eigen::MatrixXd> principal_log(const Eigen::MatrixXd& q);

}  // namespace lagroid
