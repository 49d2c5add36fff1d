#pragma once
/// How the least value of f(x; theta) on a manifold, and the point x* where it is taken, change with theta:
///
///     d f* / d theta_k = (d_k f)(x*),                               (envelope theorem)
///     Hess f(x*)[xi_k] = -grad (d_k f)(x*),   xi_k = d x* / d theta_k   (implicit function theorem)
///
/// with the Riemannian Hessian and gradient, by conjugate gradients in the tangent space (tangent_solver.hpp). Nothing
/// is differenced; of an objective without a Hessian of its own `Objective::hessian` differences gradients, which
/// leaves some ten digits of xi_k.
///
///     using namespace optimisation;
///     const Result found = minimise(manifold, f, start, method, {.relative_gradient = 1e-9});
///     const auto by = minimum_derivatives(manifold, f, found.x, entries_named(f.parameters(), "A"));
///     std::cout << by.value_by << '\n' << by.minimiser_by << by.message << '\n';
///
/// Requires a point near a minimum, which Newton's method first takes to where rounding lets it go, and entries that f
/// has. Numbers never throw: how it ended is a MinimumStatus. Where the minimum is not strict, as along rotations that
/// f does not see or with a multiple eigenvalue, x* has no derivative; the least value still has one by every theta_k
/// for which grad (d_k f) has no part along directions that are flat, to first order: all minima beside x* then agree
/// on it. (Absil, Mahony and Sepulchre, Optimization Algorithms on Matrix Manifolds, 2008, chapter 5; J. Danskin, SIAM
/// J. Appl. Math. 14 (1966) 641.)

#include <lagroid/solvers/optimisation/minimise.hpp>
#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>
#include <lagroid/solvers/optimisation/sensitivity/tangent_solver.hpp>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::optimisation {

enum class MinimumStatus {
  strict,           ///< the Hessian is positive: value and minimiser have derivatives
  not_strict,       ///< it vanishes along a tangent direction: the value may have derivatives, the minimiser has none
  no_minimum,       ///< f falls along a tangent direction
  not_critical,     ///< f still has a slope, and Newton's method does not take it away
  iteration_limit,  ///< the equations were not solved
  not_finite,       ///< a NaN or an infinity appeared, or the point is none of the manifold
};
std::string_view to_string(MinimumStatus status);

struct MinimumOptions {
  int corrections = 6;       ///< of the point by Newton's method, at most
  bool value_alone = false;  ///< no equation is solved for the minimiser of a strict minimum
  TangentSolverOptions solver = {};
};

struct MinimumDerivatives {
  MinimumStatus status = MinimumStatus::not_finite;
  std::string message;  ///< one line on derivatives that there are not
  Point x;              ///< as Newton's method left it
  double value = std::numeric_limits<double>::quiet_NaN();
  double gradient = std::numeric_limits<double>::quiet_NaN();  ///< |grad f| that is left there
  /// |Hess^{-1} grad f|: how far x* is from there, to first order, and at least what rounding leaves of grad f over the
  /// least curvature. Of a strict minimum.
  double distance = std::numeric_limits<double>::quiet_NaN();
  double least_curvature = std::numeric_limits<double>::quiet_NaN();
  double largest_curvature = std::numeric_limits<double>::quiet_NaN();
  std::vector<ParameterEntry> parameters;
  double length = 1;               ///< one that is not small beside x
  Eigen::RowVectorXd value_by;     ///< not a number where the least value has no derivative
  Eigen::RowVectorXd value_sizes;  ///< of what these are parts of: |D d_k f|, over that length
  Eigen::MatrixXd minimiser_by;    ///< a column in E for each; not numbers unless the minimum is strict, and by
                                   ///< parameters of which no slope of d_k f is known
  /// Of the largest column of a table, the worst, by what is left: the distance times the rate at which columns change
  /// along it (third derivatives of f), residuals over the least curvature, and the rounding of a Hessian of this
  /// condition.
  double digits = 0;
  /// To which derivatives of the value are known: the slope of d_k f over the distance, and rounding of its parts.
  double value_error = std::numeric_limits<double>::quiet_NaN();
  double value_digits = 0;  ///< of the largest of them, or of the largest of their parts where the value has none
  Evaluations evaluations;
  long iterations = 0;  ///< of conjugate gradients

  bool strict() const { return status == MinimumStatus::strict; }
  /// Whether it is one to second order.
  bool is_minimum() const { return strict() || status == MinimumStatus::not_strict; }
  /// Whether derivatives of the least value have not one digit above rounding, as of a fit without residual.
  bool value_is_at_rest() const;
  /// Whether the least value has a derivative by the k-th of the parameters.
  bool value_has(Eigen::Index k) const { return value_by(k) == value_by(k); }
};

/// At the minimum near x, a point of the manifold, by these parameters.
MinimumDerivatives minimum_derivatives(const Manifold& manifold, const ParametricObjective& objective, const Point& x,
                                       const std::vector<ParameterEntry>& by, const MinimumOptions& options = {});

}  // namespace lagroid::optimisation
