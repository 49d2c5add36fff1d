#pragma once
/// Implicit steps y = z tau(h g(y)) of any size h, by following their solution from h = 0 (pseudo-arclength
/// continuation):
///
///     v = h g(z tau(v)),    h = sinh(s),    the curve (v, s) that starts at (0, 0).
///
/// From v = 0 Newton's iteration converges for small h only, and a homotopy in h ends where the curve turns back in h;
/// one along its arclength does not.
///
///     const GroupoidFibre<SO3> fibre(SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9)));
///     const AutomaticField field(fibre, [](const auto& y) { return y.diagonal().eval(); });  // lie_differentials.hpp
///     const auto step = solve_implicit_step(ImplicitStep{fibre, field, 100.0});  // h = 100
///
/// Returns the solution with its status: `not_converged` (limit of steps), `stagnated` (no step along the curve is
/// small enough), `ill_conditioned` (round-off above the tolerance), `not_finite`. `SolutionPath::reach` throws
/// std::invalid_argument for a step nearer to zero than one already reached. The equation is [N] (1.1); the
/// continuation is ours.

#include <lagroid/core/matrices/factored_matrix.hpp>
#include <lagroid/solvers/newton/lie_newton.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lagroid {

/// How far and how finely a path is followed.
struct ArclengthOptions {
  double tolerance = 1e-13;   ///< the norm of f at the end is at most tolerance * (1 + h)
  int plain_iterations = 15;  ///< of Newton before the path (solve_implicit_step)
  int max_steps = 20000;
  double first_step = 0.1;
  double largest_step = 1.0;
};

template <class F> struct ArclengthResult {
  SolveStatus status = SolveStatus::not_converged;
  typename F::Point y;
  typename F::Vector v;
  double h = 0;             ///< where y is a solution: the step wanted, or how far the path was followed
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
template <SourceFibre F, class Field> class SolutionPath {
 public:
  /// The path sets out towards h > 0, or where `direction` is negative towards h < 0.
  SolutionPath(const F& fibre, const Field& field, const ArclengthOptions& options = {}, double direction = 1)
      : fibre_(fibre),
        field_(field),
        options_(options),
        n_(fibre.dimension()),
        direction_(std::copysign(1.0, direction)),
        step_(options.first_step) {
    x_ = Column::Zero(n_ + 1);
    next_ = x_;
    tangent_.resize(n_ + 1);
    tangent_ << field_.g(fibre_.centre()), 1;
    tangent_ *= direction_ / tangent_.norm();
  }

  /// Follows the path until it first meets the step h. Several steps must be reached in the order in which the path
  /// meets them first, those further from zero later; throws std::invalid_argument for others. `not_converged` at the
  /// limit of steps, `stagnated` where no step along the path is small enough, `ill_conditioned` where the path meets h
  /// but round-off is above the tolerance; `h` and `v` are then where it was followed to.
  ArclengthResult<F> reach(double h) {
    ArclengthResult<F> out;
    if (!std::isfinite(h)) {
      out.status = SolveStatus::not_finite;
      return out;
    }
    if (direction_ * h < furthest_)
      throw std::invalid_argument("SolutionPath: a step that lies nearer to zero than one already reached");
    furthest_ = direction_ * h;
    const auto goal = std::asinh(Scalar(h));
    const auto between = [&] { return x_(n_) != next_(n_) && (x_(n_) - goal) * (next_(n_) - goal) <= 0; };
    while (!(between() && arrive(h, x_ + (goal - x_(n_)) / (next_(n_) - x_(n_)) * (next_ - x_), out))) {
      out.status = advance();
      if (out.status != SolveStatus::converged) {
        out.v = x_.head(n_);
        out.y = fibre_.at(out.v);
        out.h = double(std::sinh(x_(n_)));
        const ImplicitStep<F, Field> equation(fibre_, field_, out.h);
        out.residual = norm_of(equation, equation.residual(out.y, out.v));
        out.factorisations = factorisations_;
        break;
      }
    }
    out.steps = steps_;
    return out;
  }

 private:
  using Scalar = typename F::Vector::Scalar;
  using Square = Eigen::MatrixX<Scalar>;
  using Column = Eigen::VectorX<Scalar>;

  /// Newton's iteration in the plane through x across `normal`.
  struct Corrected {
    bool converged = false;
    Scalar contraction = 0;
    Column tangent;  ///< at x, on the side of the normal
    /// The sign of det(Df, tangent), constant along a path of regular points: that of h at its start.
    double orientation = 0;
  };
  Corrected correct(Column& x, const Column& normal, long& factorisations) const {
    Corrected result;
    const Column plane = x;
    Square matrix(n_ + 1, n_ + 1);
    Column right(n_ + 1);
    Scalar last = 0;
    for (int k = 0; k < 10; ++k) {
      const typename F::Vector v = x.head(n_);
      const ImplicitStep<F, Field> equation(fibre_, field_, double(std::sinh(x(n_))));
      const auto y = fibre_.at(v);
      matrix.topLeftCorner(n_, n_) = equation.chart_differential(y, v);
      matrix.topRightCorner(n_, 1) = -std::cosh(x(n_)) * field_.g(y);
      matrix.bottomRows(1) = normal.transpose();
      right << equation.residual(y, v), normal.dot(x - plane);
      const FactoredMatrix<Scalar> lu(matrix);
      ++factorisations;
      const Column move = lu.solve(right);
      const Scalar size = move.norm();
      if (!std::isfinite(size)) return result;
      if (k == 1) result.contraction = size / last;
      if (k > 0 && size > 0.5 * last && size > 1e-9) return result;
      last = size;
      x -= move;
      if (size < 1e-7 * (1 + x.norm())) {
        result.converged = true;
        result.tangent = lu.solve(Column::Unit(n_ + 1, n_)).normalized();
        result.orientation = lu.sign_of_determinant();
        return result;
      }
    }
    return result;
  }

  /// Whether the path meets h near x: the solution there, or what comes nearest to one.
  bool arrive(double h, Column x, ArclengthResult<F>& out) const {
    const ImplicitStep<F, Field> equation(fibre_, field_, h);
    out.factorisations = factorisations_;
    x(n_) = std::asinh(Scalar(h));
    if (!correct(x, Column::Unit(n_ + 1, n_), out.factorisations).converged) return false;
    LieNewtonOptions polish;
    polish.iteration = LieIteration::version2;
    polish.tolerance = options_.tolerance * (1 + std::abs(h));
    polish.max_iterations = 4;
    const auto solved = lie_newton(equation, typename F::Vector(x.head(n_)), polish);
    out.factorisations += solved.iterations;
    out.status = solved.converged() ? SolveStatus::converged : SolveStatus::ill_conditioned;
    out.y = solved.y;
    out.v = solved.v;
    out.h = h;
    out.residual = solved.residual;
    return true;
  }

  /// One step further: the path runs from x_ to next_.
  SolveStatus advance() {
    x_ = next_;
    while (steps_ < options_.max_steps) {
      ++steps_;
      Column next = x_ + step_ * tangent_;
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
  Column x_;     ///< (v, s) at the start of the segment that was followed last
  Column next_;  ///< and at its end
  Column tangent_;
  double furthest_ = 0;  ///< the last step wanted, along the direction
  int steps_ = 0;
  long factorisations_ = 0;
};

/// The solution on the path at the equation's step.
template <SourceFibre F, class Field>
ArclengthResult<F> solve_along_path(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  return SolutionPath<F, Field>(equation.fibre(), equation.field(), options, std::copysign(1.0, equation.step()))
      .reach(equation.step());
}

/// Plain Newton (version 1) for a few iterations.
template <SourceFibre F, class Field>
LieNewtonResult<F> solve_plainly(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  LieNewtonOptions plain;
  plain.tolerance = options.tolerance * (1 + std::abs(equation.step()));
  plain.max_iterations = options.plain_iterations;
  return lie_newton(equation, F::Vector::Zero(equation.fibre().dimension()), plain);
}

/// The default for implicit steps: plain Newton, then the path.
template <SourceFibre F, class Field>
ArclengthResult<F> solve_implicit_step(const ImplicitStep<F, Field>& equation, const ArclengthOptions& options = {}) {
  const auto newton = solve_plainly(equation, options);
  if (!newton.converged()) {
    auto path = solve_along_path(equation, options);
    path.factorisations += newton.iterations;
    return path;
  }
  return {newton.status, newton.y, newton.v, equation.step(), newton.residual, 0, newton.iterations};
}

}  // namespace lagroid
