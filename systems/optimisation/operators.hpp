#pragma once
/// Symmetric matrices that need not be written down, y = A x, and the eigenvalues that are references for minima.
///
///     const Eigen::VectorXd d = Eigen::VectorXd::LinSpaced(100, 1, 100);
///     const optimisation::SymmetricOperator a{100, [d](const auto& x, auto y) { y = d.asDiagonal() * x; }};
///     const Eigen::VectorXd least = optimisation::smallest_eigenvalues(a, 3);
///
/// Requires that `apply` is symmetric; `spectrum` throws std::runtime_error where it sees that it is not.

#include <Eigen/Core>

#include <functional>
#include <utility>

namespace lagroid::optimisation {

/// y = A x for a symmetric A, column by column of x: all that an eigenvalue problem needs of it.
struct SymmetricOperator {
  Eigen::Index size = 0;
  std::function<void(const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> y)> apply;

  /// A matrix that is there, dense or sparse.
  template <class A> static SymmetricOperator of(A a) {
    return {a.rows(), [a = std::move(a)](const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> y) {
              y.noalias() = a * x;
            }};
  }
};

/// The entry (i, j) of A, and A with it and (j, i) changed by so much.
double entry_of(const SymmetricOperator& a, Eigen::Index i, Eigen::Index j);
SymmetricOperator with_changed_entry(const SymmetricOperator& a, Eigen::Index i, Eigen::Index j, double by);

/// Bounds of the spectrum that are 1e-4 of its width outside at most, by Lanczos' iteration (Spectra). Not finite where
/// A is not. Throws std::runtime_error where A is not symmetric.
std::pair<double, double> spectrum(const SymmetricOperator& a);

/// The `count` smallest eigenvalues, increasing, to round-off: the reference for `Rayleigh` (of -A) and `Brockett`.
Eigen::VectorXd smallest_eigenvalues(const SymmetricOperator& a, Eigen::Index count);

}  // namespace lagroid::optimisation
