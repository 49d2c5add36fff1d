#pragma once
/// A regular square matrix whose size is known at run time, factored to solve with, P A = L U, over double or long
/// double; compiled once, in the library.
///
/// Newton's methods on groups of any size factor at each iteration, and Eigen would compile that in every file anew
/// (docs/decisions/72_expressions_cost_their_square.md).
///
///     const FactoredMatrix<double> lu(Eigen::MatrixXd{{0, 2}, {4, 0}});
///     const Eigen::VectorXd x = lu.solve(Eigen::Vector2d(1, 2));  // (0.5, 0.5)
///     const int sign = lu.sign_of_determinant();                   // -1
///
/// Requires a square matrix. Of a singular one the solution is not finite. Nothing throws.

#include <Eigen/Core>

#include <memory>

namespace lagroid {

/// P A = L U with partial pivoting.
template <class S> class FactoredMatrix {
 public:
  explicit FactoredMatrix(const Eigen::MatrixX<S>& a);
  Eigen::VectorX<S> solve(const Eigen::VectorX<S>& b) const;
  int sign_of_determinant() const;

 private:
  std::shared_ptr<const Eigen::PartialPivLU<Eigen::MatrixX<S>>> lu_;
};

}  // namespace lagroid
