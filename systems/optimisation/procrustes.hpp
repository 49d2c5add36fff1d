#pragma once
/// Procrustes' problem, the orthogonal matrix that best takes one matrix to another:
///
///     min |A X - B|_F^2,    X^T X = I.
///
/// Where X is square the solution is known from a singular value decomposition. Sizes that do not fit throw
/// std::invalid_argument. [V] (5.9), (5.10)

#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace lagroid::optimisation {

/// f(X) = |A X - B|_F^2 on St(m, n), A of l x n, B of l x m ([V] (5.9), (5.10)), by A^T A and A^T B. Unbalanced for
/// m < n; balanced for m = n, where the minimum is known (`balanced_procrustes`) and each component of O(n) has one of
/// its own: methods stay in the component in which they start.
class Procrustes final : public ParametricObjective {
 public:
  /// Throws std::invalid_argument where sizes do not fit.
  Procrustes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

  std::string name() const override { return "Procrustes"; }
  double evaluate(const Point& x, Vector& gradient) const override;
  double value(const Point& x) const override;
  void hessian(const Point& x, const Vector& v, Vector& h) const override;
  /// `A` and `B`.
  std::vector<ParameterTable> parameters() const override;
  double parameter(const ParameterEntry& which) const override;
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override;
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override;

 private:
  Eigen::MatrixXd a_, b_;
  mutable Eigen::MatrixXd residual_;
};

/// The minimum over O(n), or over the component where det X = `component` (1 or -1; 0: both): X = U D V^T with A^T B =
/// U S V^T and D = I but for a last entry -1 where the component requires it.
Eigen::MatrixXd balanced_procrustes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, int component = 0);

}  // namespace lagroid::optimisation
