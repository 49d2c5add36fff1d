#pragma once
/// Linear equations with the Riemannian Hessian of f at a point,
///
///     Hess f(x)[v] = b,    v, b in T_x Q,
///
/// by conjugate gradients in the tangent space: what they need is the Hessian times a vector, and nothing of the size
/// n x n is made. Residuals are kept orthogonal to a few hundred of those before, so that on small tangent spaces it
/// ends after as many steps as there are directions, however badly they are scaled.
///
///     using namespace optimisation;
///     Problem problem(manifold, objective);
///     problem.evaluate(state);
///     TangentSolver solver(problem, state);
///     optimisation::Vector v;
///     if (solver.solve(b, v) == TangentSolveStatus::flat) std::cout << "no strict minimum\n";
///
/// Requires an evaluated state and a problem that outlive it, and a tangent b. Numbers never throw: how it ended is a
/// TangentSolveStatus. (M. Hestenes and E. Stiefel, J. Res. Nat. Bur. Standards 49 (1952) 409; Absil, Mahony and
/// Sepulchre, Optimization Algorithms on Matrix Manifolds, 2008, section 8.3.)

#include <lagroid/solvers/optimisation/minimise.hpp>

#include <string_view>
#include <vector>

namespace lagroid::optimisation {

enum class TangentSolveStatus {
  solved,
  flat,             ///< along a direction that b has a part of the Hessian vanishes, to the digits that it has
  falling,          ///< along a direction it is negative
  iteration_limit,  ///< more steps than there are directions did not suffice
  not_finite,       ///< a NaN or an infinity appeared
};
std::string_view to_string(TangentSolveStatus status);

struct TangentSolverOptions {
  double residual = 1e-13;  ///< |Hess v - b| over |b|, as the recurrence has it
  /// Curvatures below this part of the largest vanish: nothing would be left of the digits of what is divided by them.
  double flat = 1e-9;
  long kept = 400;      ///< residuals to which others are kept orthogonal
  long iterations = 0;  ///< 0: three times the dimension, and fifty
};

class TangentSolver {
 public:
  /// Estimates the largest curvature by a few steps of the power method.
  TangentSolver(Problem& problem, const EvaluatedPoint& state, TangentSolverOptions options = {});

  /// v with Hess v = b, or with a residual that is `enough`; where that is not solved the last iterate.
  TangentSolveStatus solve(const Vector& b, Vector& v, double enough = 0);
  /// |Hess v - b| of the last solution, computed anew.
  double residual() const { return residual_; }
  /// The norm of the Hessian: the largest |Hess v| / |v| that was met.
  double largest_curvature() const { return largest_; }
  /// The least <v, Hess v> / |v|^2: by steps of the inverse power method from a random vector; where the status is not
  /// `solved` that along the direction that it met. Also `direction`, of the length one.
  TangentSolveStatus least_curvature(double& curvature, Vector& direction);
  long iterations() const { return iterations_; }

 private:
  double inner(const Vector& u, const Vector& v) const { return problem_.manifold().inner(state_.x, u, v); }
  /// curved_ = Hess v, and the largest curvature with it.
  void apply(const Vector& v);
  /// A tangent vector of the length one; the same numbers everywhere.
  Vector any_direction() const;
  void keep_orthogonal(Vector& residual) const;
  TangentSolveStatus iterate(const Vector& b, Vector& v, double enough);

  Problem& problem_;
  const EvaluatedPoint& state_;
  TangentSolverOptions options_;
  double largest_ = 0;
  double residual_ = 0;
  double met_curvature_ = 0;
  long iterations_ = 0;
  std::vector<Vector> kept_;  ///< residuals, of the length one
  Vector curved_, direction_, left_;
};

}  // namespace lagroid::optimisation
