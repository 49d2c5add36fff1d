#pragma once
/// Symmetric matrices that need not be written down.

#include <Eigen/Core>

#include <functional>
#include <utility>

namespace lagroid::optimisation {

/// y = A x for a symmetric A, column by column of x: all that an eigenvalue problem asks of it.
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

/// Least and largest eigenvalue, to about `digits`, by Lanczos' iteration with full orthogonalisation, from a fixed
/// start; never inside the spectrum by more than that.
std::pair<double, double> spectrum(const SymmetricOperator& a, double digits = 1e-3);

}  // namespace lagroid::optimisation
