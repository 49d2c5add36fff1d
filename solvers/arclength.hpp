#pragma once
/// Implicit steps of any size, by following their solution from step zero.

#include <lagroid/solvers/lie_newton.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

/// How far and how finely a path is followed.
struct ArclengthOptions {
  double tolerance = 1e-13;  ///< the norm of f at the end is at most tolerance * (1 + h)
  int max_steps = 20000;
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
  long factorisations = 0;  ///< of the Jacobian, from the start of the path
  bool converged() const { return status == SolveStatus::converged; }
};

/// The solutions of y = z tau(h g(y)) that are connected to y = z at h = 0: pseudo-arclength continuation of
/// v = h g(z tau(v)) in (v, s), h = sinh(s). The path may turn back in h, and v may leave the principal branch: it is
/// then of any size. A step along the path is taken when Newton's corrector contracts well and the tangent has not
/// turned far, and when the determinant of (Df, tangent) keeps its sign and h its own, as they do along a path of
/// regular points (h = 0 has the one solution v = 0): a corrector that landed on another stretch of the path, on which
/// h runs the other way, is found out by it. Else the step is halved. (Ours; [N] stops where its iterations do.)
template <AlphaFibre F, class Field> class SolutionPath {
 public:
  /// The path sets out towards h > 0, or where `direction` is -1 towards h < 0.
  SolutionPath(const F& fibre, const Field& field, const ArclengthOptions& options = {}, double direction = 1)
      : fibre_(fibre),
        field_(field),
        options_(options),
        n_(fibre.dimension()),
        direction_(direction),
        step_(options.first_step) {
    x_ = VectorXd::Zero(n_ + 1);
    next_ = x_;
    tangent_.resize(n_ + 1);
    tangent_ << field_.g(fibre_.centre()), 1;
    tangent_ *= direction / tangent_.norm();
  }

  /// Follows the path until it first meets the step h. Several steps are to be asked for in the order in which the path
  /// meets them first, those further from zero later. `not_converged` at the limit of steps, `stagnated`
  /// where no step along the path is small enough; `h` and `v` then tell how far it was followed.
  ArclengthResult<F> reach(double h) {
    ArclengthResult<F> out;
    const double goal = std::asinh(h);
    const auto between = [&] { return x_(n_) != next_(n_) && (x_(n_) - goal) * (next_(n_) - goal) <= 0; };
    while (!(between() && arrive(h, x_ + (goal - x_(n_)) / (next_(n_) - x_(n_)) * (next_ - x_), out))) {
      out.status = advance();
      if (out.status != SolveStatus::converged) {
        out.v = x_.head(n_);
        out.y = fibre_.at(out.v);
        out.h = std::sinh(x_(n_));
        out.residual = fibre_.norm(ImplicitStep<F, Field>(fibre_, field_, out.h).residual(out.y, out.v));
        out.factorisations = factorisations_;
        break;
      }
    }
    out.steps = steps_;
    return out;
  }

 private:
  using MatrixXd = Eigen::MatrixXd;
  using VectorXd = Eigen::VectorXd;

  /// Newton's iteration in the plane through x across `normal`.
  struct Corrected {
    bool converged = false;
    double contraction = 0;
    VectorXd tangent;  ///< at x, on the side of the normal
    double orientation =
        0;  ///< the sign of det(Df, tangent), constant along a path of regular points: that of h at its start
  };
  static double sign_of_determinant(const Eigen::PartialPivLU<MatrixXd>& lu) {
    return lu.permutationP().determinant() * lu.matrixLU().diagonal().array().sign().prod();
  }
  Corrected correct(VectorXd& x, const VectorXd& normal, long& factorisations) const {
    Corrected result;
    const VectorXd plane = x;
    MatrixXd matrix(n_ + 1, n_ + 1);
    VectorXd right(n_ + 1);
    double last = 0;
    for (int k = 0; k < 10; ++k) {
      const typename F::Vector v = x.head(n_);
      const ImplicitStep<F, Field> equation(fibre_, field_, std::sinh(x(n_)));
      const auto y = fibre_.at(v);
      matrix.topLeftCorner(n_, n_) = equation.chart_differential(y, v);
      matrix.topRightCorner(n_, 1) = -std::cosh(x(n_)) * field_.g(y);
      matrix.bottomRows(1) = normal.transpose();
      right << equation.residual(y, v), normal.dot(x - plane);
      const Eigen::PartialPivLU<MatrixXd> lu(matrix);
      ++factorisations;
      const VectorXd move = lu.solve(right);
      const double size = move.norm();
      if (!std::isfinite(size)) return result;
      if (k == 1) result.contraction = size / last;
      if (k > 0 && size > 0.5 * last && size > 1e-9) return result;
      last = size;
      x -= move;
      if (size < 1e-7 * (1 + x.norm())) {
        result.converged = true;
        result.tangent = lu.solve(VectorXd::Unit(n_ + 1, n_)).normalized();
        result.orientation = sign_of_determinant(lu);
        return result;
      }
    }
    return result;
  }

  /// A solution at h from a point of the path near it.
  bool arrive(double h, VectorXd x, ArclengthResult<F>& out) const {
    const ImplicitStep<F, Field> equation(fibre_, field_, h);
    out.factorisations = factorisations_;
    x(n_) = std::asinh(h);
    if (!correct(x, VectorXd::Unit(n_ + 1, n_), out.factorisations).converged) return false;
    LieNewtonOptions polish;
    polish.iteration = LieIteration::version2;
    polish.tolerance = options_.tolerance * (1 + std::abs(h));
    polish.max_iterations = 4;
    const auto solved = lie_newton(equation, typename F::Vector(x.head(n_)), polish);
    out.factorisations += solved.iterations;
    out.status = solved.status;
    out.y = solved.y;
    out.v = solved.v;
    out.h = h;
    out.residual = solved.residual;
    return solved.converged();
  }

  /// One step further: the path runs from x_ to next_.
  SolveStatus advance() {
    x_ = next_;
    while (steps_ < options_.max_steps) {
      ++steps_;
      VectorXd next = x_ + step_ * tangent_;
      const Corrected corrected = correct(next, tangent_, factorisations_);
      if (!corrected.converged || corrected.contraction > 0.3 || corrected.tangent.dot(tangent_) < 0.7 ||
          corrected.orientation != direction_ || next(n_) * direction_ <= 0) {
        step_ *= 0.5;
        if (step_ < 1e-8) return SolveStatus::stagnated;
        continue;
      }
      next_ = next;
      tangent_ = corrected.tangent;
      step_ = std::min(options_.largest_step, step_ * (corrected.contraction < 0.05   ? 2.0
                                                       : corrected.contraction < 0.15 ? 1.3
                                                                                      : 0.9));
      return SolveStatus::converged;
    }
    return SolveStatus::not_converged;
  }

  F fibre_;
  Field field_;
  ArclengthOptions options_;
  Eigen::Index n_;
  double direction_;
  double step_;
  VectorXd x_;     ///< (v, s) at the start of the segment that was followed last
  VectorXd next_;  ///< and at its end
  VectorXd tangent_;
  int steps_ = 0;
  long factorisations_ = 0;
};

/// The solution on the path at the equation's step.
template <AlphaFibre F, class Field>
ArclengthResult<F> solve_along_path(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  return SolutionPath<F, Field>(equation.fibre(), equation.field(), options, std::copysign(1.0, equation.step()))
      .reach(equation.step());
}

/// Plain Newton (version 1) for a few iterations.
template <AlphaFibre F, class Field>
LieNewtonResult<F> solve_plainly(const ImplicitStep<F, Field>& equation, double tolerance) {
  LieNewtonOptions plain;
  plain.tolerance = tolerance * (1 + std::abs(equation.step()));
  plain.max_iterations = 15;
  return lie_newton(equation, F::Vector::Zero(equation.fibre().dimension()), plain);
}

/// The default for implicit steps: plain Newton, then the path.
template <AlphaFibre F, class Field>
ArclengthResult<F> solve_implicit_step(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  const auto newton = solve_plainly(equation, options.tolerance);
  if (!newton.converged()) {
    auto path = solve_along_path(equation, options);
    path.factorisations += newton.iterations;
    return path;
  }
  return {newton.status, newton.y, newton.v, equation.step(), newton.residual, 0, newton.iterations};
}

}  // namespace lagroid
