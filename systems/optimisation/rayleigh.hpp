#pragma once
/// Eigenvectors as minima: of the Rayleigh quotient on the sphere, and of Brockett's function on Stiefel manifolds,
///
///     f(v) = -v^T A v,    f(X) = Trace(X^T A X N).
///
///     const Eigen::MatrixXd a = optimisation::random_symmetric(100, 1);  // size, seed
///     const optimisation::Brockett f(optimisation::SymmetricOperator::of(a), Eigen::Vector3d(1, 2, 3));
///
/// Derivatives of their minima are by the entries of A and by the weights: an entry (i, j) changes (j, i) with it, so
/// that d (x^T A x) / d A_ij = 2 x_i x_j, and x_i^2 on the diagonal.
///
/// Weights of Brockett's function must rise and not be negative (std::invalid_argument). [V] 5.3.1, (5.7)

#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>
#include <lagroid/systems/optimisation/operators.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::optimisation {

/// f(v) = -v^T A v on the sphere: its minima are the unit eigenvectors of the largest eigenvalue ([V] 5.3.1). The
/// Riemannian gradient has the Lipschitz constant 2 (w_max - w_min).
class Rayleigh final : public ParametricObjective {
 public:
  explicit Rayleigh(SymmetricOperator a);

  std::string name() const override { return "Rayleigh quotient"; }
  double evaluate(const Point& x, Vector& gradient) const override;
  void hessian(const Point& x, const Vector& v, Vector& h) const override;
  std::optional<double> lipschitz() const override { return lipschitz_; }
  /// `A`.
  std::vector<ParameterTable> parameters() const override;
  double parameter(const ParameterEntry& which) const override;
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override;
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override;

 private:
  SymmetricOperator a_;
  double lipschitz_;
};

/// f(X) = Trace(X^T A X N) on St(m, n), N = diag(mu), 0 <= mu_1 <= ... <= mu_m: at the global minimum the columns are
/// eigenvectors of the m smallest eigenvalues, the last of the smallest ([V] (5.7)). Lipschitz constant
/// 2 (w_max - w_min) mu_m, since A - c I gives the same gradient for every c.
class Brockett final : public ParametricObjective {
 public:
  /// Throws std::invalid_argument unless the weights are as above.
  Brockett(SymmetricOperator a, Eigen::VectorXd weights);

  std::string name() const override { return "Brockett"; }
  double evaluate(const Point& x, Vector& gradient) const override;
  void hessian(const Point& x, const Vector& v, Vector& h) const override;
  std::optional<double> lipschitz() const override { return lipschitz_; }
  /// `weights` and `A`. Weights that are changed must still rise.
  std::vector<ParameterTable> parameters() const override;
  double parameter(const ParameterEntry& which) const override;
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override;
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override;

 private:
  SymmetricOperator a_;
  Eigen::VectorXd weights_;
  double lipschitz_;
};

}  // namespace lagroid::optimisation
