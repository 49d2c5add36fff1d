#pragma once
/// Implicit steps of any size, by following their solution from step zero.

#include <lagroid/solvers/lie_newton.hpp>

#include <algorithm>

namespace lagroid {

/// How far and how finely a path is followed.
struct ArclengthOptions {
  double tolerance = 1e-13;  ///< the norm of f at the end is at most tolerance * (1 + h)
  int max_steps = 2000;
  double first_step = 0.1;
  double largest_step = 1.0;
};

template <class F> struct ArclengthResult {
  SolveStatus status = SolveStatus::not_converged;
  typename F::Point y;
  typename F::Vector v;
  double h = 0;             ///< where y is a solution: the step asked for, or how far the path was followed
  double residual = 0;      ///< the norm of f there
  int steps = 0;            ///< along the path, those undone included
  long factorisations = 0;  ///< of the Jacobian
  bool converged() const { return status == SolveStatus::converged; }
};

/// Solves y = z tau(h g(y)) by pseudo-arclength continuation of v = h g(z tau(v)) in (v, s), h = sinh(s), from v = 0 at
/// h = 0. The path may turn back in h, and v may leave the principal branch: `v` is then of any size. A step is taken
/// when Newton's corrector contracts well and the tangent has not turned far, else it is halved. `not_converged` at the
/// limit of steps, `stagnated` where no step is small enough.
template <AlphaFibre F, class Field>
ArclengthResult<F> solve_along_path(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  const F& fibre = equation.fibre();
  const Field& field = equation.field();
  const Eigen::Index n = fibre.dimension();
  ArclengthResult<F> out;

  // f and its derivative at x = (v, s).
  const auto evaluate = [&](const VectorXd& x, VectorXd& f, MatrixXd& derivative) {
    const typename F::Vector v = x.head(n);
    const ImplicitStep<F, Field> at(fibre, field, std::sinh(x(n)));
    const auto y = fibre.at(v);
    f = at.residual(y, v);
    derivative.resize(n, n + 1);
    derivative.leftCols(n) = at.chart_differential(y, v);
    derivative.col(n) = -std::cosh(x(n)) * field.g(y);
    ++out.factorisations;
  };
  struct Corrected {
    bool converged = false;
    double contraction = 0;
    VectorXd tangent;
  };
  // Newton's iteration in the plane through `x` across `normal`.
  const auto correct = [&](VectorXd& x, const VectorXd& normal) {
    Corrected result;
    const VectorXd plane = x;
    VectorXd f;
    MatrixXd derivative;
    MatrixXd matrix(n + 1, n + 1);
    VectorXd right(n + 1);
    double last = 0;
    for (int k = 0; k < 10; ++k) {
      evaluate(x, f, derivative);
      matrix << derivative, normal.transpose();
      right << f, normal.dot(x - plane);
      const Eigen::PartialPivLU<MatrixXd> lu(matrix);
      const VectorXd move = lu.solve(right);
      const double size = move.norm();
      if (!std::isfinite(size)) return result;
      if (k == 1) result.contraction = size / last;
      if (k > 0 && size > 0.5 * last && size > 1e-9) return result;
      last = size;
      x -= move;
      if (size < 1e-7 * (1 + x.norm())) {
        result.converged = true;
        result.tangent = lu.solve(VectorXd::Unit(n + 1, n)).normalized();
        return result;
      }
    }
    return result;
  };
  // At the step asked for, from a point near it.
  const double goal = std::asinh(equation.step());
  const auto arrive = [&](VectorXd x) {
    x(n) = goal;
    if (!correct(x, VectorXd::Unit(n + 1, n)).converged) return false;
    typename F::Vector v = x.head(n);
    for (int polish = 0; polish < 4; ++polish) {
      const auto y = fibre.at(v);
      const typename F::Vector f = equation.residual(y, v);
      out.residual = equation.norm(f);
      if (out.residual <= options.tolerance * (1 + equation.step())) {
        out.status = SolveStatus::converged;
        out.y = y;
        out.v = v;
        out.h = equation.step();
        return true;
      }
      v -= equation.chart_differential(y, v).partialPivLu().solve(f);
      ++out.factorisations;
    }
    return false;
  };

  VectorXd x = VectorXd::Zero(n + 1);
  VectorXd tangent(n + 1);
  tangent << field.g(fibre.centre()), 1;
  tangent.normalize();
  double step = options.first_step;
  for (; out.steps < options.max_steps; ++out.steps) {
    VectorXd next = x + step * tangent;
    Corrected corrected = correct(next, tangent);
    if (corrected.converged && corrected.tangent.dot(tangent) < 0) corrected.tangent *= -1;
    if (!corrected.converged || corrected.contraction > 0.3 || corrected.tangent.dot(tangent) < 0.7) {
      step *= 0.5;
      if (step < 1e-8) {
        out.status = SolveStatus::stagnated;
        break;
      }
      continue;
    }
    if ((x(n) - goal) * (next(n) - goal) <= 0 && arrive(x + (goal - x(n)) / (next(n) - x(n)) * (next - x))) return out;
    x = next;
    tangent = corrected.tangent;
    step = std::min(options.largest_step, step * (corrected.contraction < 0.05   ? 2.0
                                                  : corrected.contraction < 0.15 ? 1.3
                                                                                 : 0.9));
  }
  out.v = x.head(n);
  out.y = fibre.at(out.v);
  out.h = std::sinh(x(n));
  out.residual = equation.norm(ImplicitStep<F, Field>(fibre, field, out.h).residual(out.y, out.v));
  return out;
}

/// The default: plain Newton (version 1) for a few iterations, then the path.
template <AlphaFibre F, class Field>
ArclengthResult<F> solve_implicit_step(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  LieNewtonOptions plain;
  plain.tolerance = options.tolerance * (1 + equation.step());
  plain.max_iterations = 15;
  const auto newton = lie_newton(equation, F::Vector::Zero(equation.fibre().dimension()), plain);
  if (!newton.converged()) {
    auto path = solve_along_path(equation, options);
    path.factorisations += newton.iterations();
    return path;
  }
  ArclengthResult<F> out;
  out.status = newton.status;
  out.y = newton.y;
  out.v = newton.v;
  out.h = equation.step();
  out.residual = newton.residuals.back();
  out.factorisations = newton.iterations();
  return out;
}

}  // namespace lagroid
