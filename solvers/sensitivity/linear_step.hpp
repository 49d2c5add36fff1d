#pragma once
/// One step, linearised where it is solved. With the step equations E(z; x) = 0 in the unknowns z = (w, lambda), and
/// x = (v, mu, theta) the displacement of the source, the momentum and the parameters,
///
///     E_z dz + E_x dx = 0,    dx' = X_z dz + X_x dx,    x' = (w, F+(g, lambda)).
///
/// Solved steps need no derivative of their iterations: the equations that hold at the end say all, and their transpose
/// takes gradients back. The matrix is that of the solution, not one that an iteration kept.
///
///     LinearStep step(equations, states, parameters);  // how many of each
///     step.factor();                                   // once E_z is filled in
///     const Eigen::MatrixXd end = step.forward(start);  // directions, column by column
///     const Eigen::MatrixXd back = step.backward(gradients);
///
/// `factor` returns whether all numbers are finite and E_z is regular ([G] Def. 3.5). A step in closed form has no
/// equations; one of many unknowns, each coupled to few, is a SparseStep (sparse/sparse_step.hpp). Nothing throws.
/// Source: implicit function theorem; the adjoint is that of the discrete map itself.

#include <Eigen/Core>
#include <Eigen/LU>

#include <vector>

namespace lagroid {

/// The derivative of a step, as its matrix acts and as its transpose does.
class StepDerivative {
 public:
  virtual ~StepDerivative() = default;

  /// dx' of directions dx: states, and below them parameters, which a step leaves as they are.
  virtual Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const = 0;
  /// The gradients by x of functions of x', given those by x'.
  virtual Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const = 0;
  /// The same in place: of small steps without memory of their own.
  virtual void go_forward(Eigen::MatrixXd& directions) const { directions = forward(directions); }
  virtual void go_back(Eigen::MatrixXd& gradients) const { gradients = backward(gradients); }
};

class LinearStep final : public StepDerivative {
 public:
  LinearStep(int equations, int states, int parameters);

  Eigen::MatrixXd equations_by_unknowns;  ///< E_z
  Eigen::MatrixXd equations_by_start;     ///< E_x
  Eigen::MatrixXd end_by_unknowns;        ///< X_z
  Eigen::MatrixXd end_by_start;           ///< X_x

  /// To be called when the four have been filled in.
  bool factor();

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override;
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override;
  void go_forward(Eigen::MatrixXd& directions) const override;
  void go_back(Eigen::MatrixXd& gradients) const override;

 private:
  bool is_small() const;
  template <class Count> bool factor_small(Count equations);
  double* memory(Eigen::Index size) const;
  Eigen::MatrixXd forward_large(const Eigen::MatrixXd& directions) const;
  Eigen::MatrixXd backward_large(const Eigen::MatrixXd& gradients) const;

  Eigen::VectorXd row_scale_;
  Eigen::VectorXd column_scale_;
  std::vector<Eigen::Index> order_;     ///< of the equations, in the factors of a small step
  Eigen::MatrixXd small_;               ///< their factors
  mutable std::vector<double> memory_;  ///< of directions on their way: one step is for one thread
  Eigen::PartialPivLU<Eigen::MatrixXd> large_;
};

}  // namespace lagroid
