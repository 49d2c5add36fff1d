#pragma once
/// exp, log and their differentials on SO(N), N known at run time, by the real Schur form of a skew-symmetric matrix.
///
/// In that form exp turns planes by angles, and its differential multiplies numbers, so that both are exact to
/// round-off at every size.
///
///     const SkewSpectrum<double> spectrum(x);        // x = -x^T
///     const Eigen::MatrixXd rotation = spectrum.exp();
///     const auto again = principal_log(rotation);  // a std::optional
///
/// Compiled for S = double and long double. `principal_log` returns nothing where its argument is not finite or has
/// determinant -1. Nothing throws.
///
/// Source: [N] section 2.3; the spectral forms are ours.

#include <Eigen/Core>

#include <optional>

namespace lagroid {

/// The skew-symmetric n x n matrix with the entries x above its diagonal, row by row.
template <class S> Eigen::MatrixX<S> skew(const Eigen::VectorX<S>& x, Eigen::Index n);
/// Back, of the skew-symmetric part of any square matrix.
template <class S> Eigen::VectorX<S> skew_entries(const Eigen::MatrixX<S>& a);

/// The real Schur form X = Q diag(w_1 J, w_2 J, ..., [0]) Q^T of a skew-symmetric matrix, J = [0 -1; 1 0]: planes that
/// exp(X) turns by the angles w, and an axis if n is odd.
template <class S> class SkewSpectrum {
 public:
  using Matrix = Eigen::MatrixX<S>;

  /// Not a number where an entry of x is not finite.
  explicit SkewSpectrum(const Matrix& x);

  /// exp(X).
  Matrix exp() const;
  /// dexp_X(Y) = L'_{exp(-X)} exp'_X(Y) of a skew-symmetric Y, exact: ad_X turns the parts of Y that commute and
  /// anticommute with J, for each pair of planes, by the difference and the sum of their w; with d half of either,
  /// dexp multiplies them by exp(-i d) sin(d) / d, i for J ([N] (2.10)).
  Matrix dexp(const Matrix& y) const;
  /// dexp_X^{-1}(Y). Requires that no two w have a non-zero multiple of 2 pi as difference or sum; entries are huge or
  /// not finite there.
  Matrix dexp_inverse(const Matrix& y) const;
  /// These maps in the coordinates of `skew_entries`.
  Matrix dexp_matrix() const;
  Matrix dexp_inverse_matrix() const;

  /// Q diag(f(w) J) Q^T, f odd.
  template <class F> Matrix apply(const F& f) const { return with_angles(angles_.unaryExpr(f)); }
  /// The largest |w|. Below pi, X is the principal logarithm of exp(X).
  S radius() const { return angles_.size() == 0 ? S(0) : angles_.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>(); }

 private:
  Matrix with_angles(const Eigen::VectorX<S>& angles) const;
  template <class F> void multiply(Matrix& inner, const F& factor) const;
  template <class F> Matrix multiplied(const Matrix& y, const F& factor) const;
  template <class F> Matrix matrix_of(const F& factor) const;

  Matrix basis_;
  Eigen::VectorX<S> angles_;  ///< the w, of any sign and order
};

/// The principal logarithm of an orthogonal matrix: skew-symmetric, of spectral radius at most pi; nothing where the
/// determinant is -1. Relative accuracy near the identity, where it is 2 artanh((Q + I)^{-1} (Q - I)). Eigenvalues at
/// and near -1 are no exception: each pair is a turn by nearly pi in the plane that the real Schur form finds for it.
template <class S> std::optional<Eigen::MatrixX<S>> principal_log(const Eigen::MatrixX<S>& q);

extern template class SkewSpectrum<double>;
extern template class SkewSpectrum<long double>;

}  // namespace lagroid
