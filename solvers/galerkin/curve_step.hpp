#pragma once
/// Steps (q0, p0) -> (q1, p1) along the polynomial curve whose action is stationary, of Lagrangians of any size, with
/// constraints of places and forces (the discrete Lagrange-d'Alembert principle),
///
///     p0 + C'(q0)^T lambda = -D1 L(q0, q1) - f-,    p1 = D2 L(q0, q1) + f+,    C(q1) = 0,
///     L = ext h sum_i b_i l(x(c_i), x'(c_i)),    f+- = h sum_i b_i (ends of the curve moved) F(x(c_i), x'(c_i)).
///
/// They are the steps of Midpoint, Trapezoidal and Galerkin (galerkin.hpp), whose size is a type's: inner nodes,
/// multipliers and the end are unknowns of one Newton iteration here.
///
///     CurveStep step(lagrangian, {CurveQuadrature::gauss, 3});  // of order six
///     SizedState z{q, p};
///     const StepReport report = step.take(z, /*t*/ 0, /*h*/ 0.1);
///
/// Requires a regular l. Refers to the Lagrangian. A degree of one has no inner nodes: the midpoint rule of Gauss's
/// point, the trapezoid of Lobatto's two. Constraints want Lobatto's points: the trapezoid, or the pair.
///
/// Errors: `singular`, `not_finite`, `not_converged`; the state stays as it was unless the step converged. Nothing is
/// allocated in a step, nothing throws.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.2.6, 3.2.5; Jay, SIAM J. Numer. Anal. 33 (1996).

#include <lagroid/core/continuous/curve_rule.hpp>
#include <lagroid/solvers/galerkin/sized_lagrangian.hpp>
#include <lagroid/solvers/step/sized_step.hpp>

#include <Eigen/Core>

#include <vector>

namespace lagroid {

/// Points of a quadrature and a curve's degree, 1 to 5.
struct CurveChoice {
  CurveQuadrature points = CurveQuadrature::gauss;
  int degree = 1;

  int order() const { return points == CurveQuadrature::lobatto_pair ? 2 * degree - 2 : 2 * degree; }
};

class CurveStep final : public SizedStep {
 public:
  CurveStep(const SizedLagrangian& lagrangian, const CurveChoice& choice);

  StepReport take(SizedState& z, double t, double h) override;
  bool linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) override;
  /// v with p = l_v + C'^T nu, by Newton's method; the tangent momentum is l_v, the energy <l_v, v> - l.
  void find_velocity(const SizedState& z, double t, TangentState& out) const override;

 private:
  struct Point {
    double node, weight;
    std::vector<double> value, rate;  ///< of the polynomials that are one at node j = 1 ... degree of the curve
    int multipliers = -1;             ///< where its own begin among the unknowns, and their equations; -1: it has none
  };
  using Numbers = std::vector<double>;

  void write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, double h);
  void add_point(const Point& point, const Eigen::VectorXd& q, double t, double h);
  /// Place and velocity at a point of the curve, and l there with its derivatives.
  void go_to(const Point& point, const Eigen::VectorXd& q, double t, double h);
  /// The entries of the derivatives of l_q + F + C'^T lambda, and of l_v, at the point where it is.
  double place_slope_by(const Point& point, int i, int j, bool velocity) const;
  double velocity_slope_by(int i, int j, bool velocity) const;
  /// Of the equations of node j: for the last one, whose momentum is that at the end, those of the start.
  int row_of_node(int j) const;
  /// Adds `scale` times `block` to the rows of the equations of node j, from `column` on.
  void add_to_node(int j, int column, double scale, const Eigen::MatrixXd& block);
  void add_to_node(int j, double scale, const Eigen::VectorXd& part);

  const SizedLagrangian& lagrangian_;
  int n_, k_, degree_;
  std::vector<Point> points_;
  std::vector<double> curve_nodes_, rate_at_end_;  ///< after the first; of the polynomials that are one there
  int first_multiplier_;                           ///< of the multipliers at q0
  detail::SizedNewton newton_;
  Eigen::VectorXd end_momentum_, impulse_, x_, v_, place_slope_, velocity_slope_;
  Eigen::MatrixXd place_by_, velocity_by_, gradient_;
  mutable Numbers l_, c_, f_;
  TangentState tangent_;
  SizedState end_;
};

}  // namespace lagroid
