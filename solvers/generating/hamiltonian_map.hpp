#pragma once
/// Constrained discrete Hamiltonian maps (q_k, p_k) -> (q_{k+1}, p_{k+1}) from a generating function of type I, II or
/// III:
///
///     p_k + <lambda_k, C'(q_k)> = D1 H_d+(q_k, p_{k+1}),    q_{k+1} = D2 H_d+(q_k, p_{k+1}),    C(q_{k+1}) = 0
///
/// (type II; all three stand with the class). They are symplectic on T*C^{-1}(0), as RATTLE is, which is one of them.
///
///     Phase<1, 0> point{Vector<double, 1>(1), Vector<double, 1>(0)};
///     const HamiltonianMap map(ChordLagrangian<Spring>{});  // the Spring of chord_lagrangian.hpp
///     const SolveStatus status = map.step(point, 0.1);  // h
///
/// Requires a function as the concept GeneratingFunction describes it, and a step that is not zero. The status is
/// `singular`, `left_domain`, `not_finite` or `not_converged` where there is no step; the point then stays as it was.
/// [V] (2.10), (2.13), (3.14) to (3.21)

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/status.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

namespace detail {

/// The factors of an equilibrated matrix ((A, B), (C, 0)) of N + D rows. B and C are brought to the size of A first:
/// the rows and columns of (epsilon I, B; B^T, 0) look balanced as they are.
template <int N, int D> class EquilibratedFactor {
 public:
  static constexpr int size = N + D;
  using Square = Matrix<double, size, size>;
  using Column = Vector<double, size>;

  explicit EquilibratedFactor(const Square& a) : scaling_(balanced(a)), lu_(scaling_.apply(a)) {
    lu_.setThreshold(1e-12);
  }
  bool regular() const { return lu_.isInvertible(); }
  bool positive() const { return lu_.determinant() > 0; }
  Column solve(const Column& b) const {
    return scaling_.column.cwiseProduct(lu_.solve(Column(scaling_.row.cwiseProduct(b))));
  }

 private:
  static Scaling<size> balanced(const Square& a) {
    Scaling<size> first{Column::Ones(), Column::Ones()};
    if constexpr (D > 0) {
      const auto ratio = [](double x, double of) {
        return x > 0 && of > 0 && std::isfinite(x / of) ? std::exp2(std::round(std::log2(x / of))) : 1.0;
      };
      const double block = a.template topLeftCorner<N, N>().cwiseAbs().maxCoeff();
      first.column.template tail<D>().setConstant(
          ratio(block, a.template topRightCorner<N, D>().cwiseAbs().maxCoeff()));
      first.row.template tail<D>().setConstant(ratio(block, a.template bottomLeftCorner<D, N>().cwiseAbs().maxCoeff()));
    }
    Scaling<size> then = Scaling<size>::equilibrate(first.apply(a));
    then.row = then.row.cwiseProduct(first.row);
    then.column = then.column.cwiseProduct(first.column);
    return then;
  }

  Scaling<size> scaling_;
  Eigen::FullPivLU<Square> lu_;
};

}  // namespace detail

/// A point of T*R^n with C(q) = 0, and the multipliers of the step that led to it.
template <int N, int D> struct Phase {
  Vector<double, N> q;
  Vector<double, N> p;
  Vector<double, D> multipliers = Vector<double, D>::Zero();
};

/// The map (q_k, p_k) -> (q_{k+1}, p_{k+1}) of a generating function, with C(q_{k+1}) = 0. With the multipliers
/// lambda_k at q_k and p~ = p_k + <lambda_k, C'(q_k)>,
///
///     type I     p~ = -D1 L_d(q_k, q_{k+1}),          p_{k+1} =  D2 L_d(q_k, q_{k+1})          [V] (2.10), (2.13)
///     type II    p~ =  D1 H_d+(q_k, p_{k+1}),         q_{k+1} =  D2 H_d+(q_k, p_{k+1})         [V] (3.14), (3.19)
///     type III   q_k = -D2 H_d-(q_{k+1}, p~),         p_{k+1} = -D1 H_d-(q_{k+1}, p~)          [V] (3.15), (3.21)
///
/// The sign of lambda is that of docs/notation.md; [V] has the opposite one. Without constraints (d = 0) p~ is p_k.
///
/// Momenta at q_k that differ by <nu, C'(q_k)> give the same q_{k+1}, since lambda_k takes up the difference: the map
/// is one of T*Q, Q = C^{-1}(0), and a point of T*Q is such a class of momenta. Three of its members are in use:
///
///     p_k      before the multiplier at q_k acts: what `step` takes and returns
///     p~       after it: what `leave` makes of p_k
///     tangent  the one with <H_p, C'(q)> = 0, by `project_momentum`; it alone has the order of the method
///
/// [V] (2.9) and, as printed, (3.15) and (3.21) have p~: there lambda_{k+1} is part of p_{k+1}, and C(q_1) = 0 holds
/// only for a consistent p_0, as `leave` makes it.
template <GeneratingFunction F> class HamiltonianMap {
 public:
  static constexpr int n = F::dimension;
  static constexpr int d = F::constraints;
  using Point = Phase<n, d>;

  explicit HamiltonianMap(F function) : function_(std::move(function)) {}

  const F& function() const { return function_; }

  /// A step h of either sign, not zero, by Newton's method from the point itself with exact second derivatives, until
  /// each equation is left with the rounding of its terms.
  /// Leaves `point` as it is unless it converges; else
  /// - singular: the matrix of the step is, as where C' has not full rank
  /// - left_domain: a solution beyond a fold, where the determinant of the step's matrix has not the sign that it has
  ///   where the iteration begins
  /// - not_finite: a NaN or an infinity in the point, the function or the iteration
  /// - not_converged: no solution was found, as of a step too long.
  /// No allocation.
  SolveStatus step(Point& point, double h) const;

  /// p <- p + <lambda, C'(q)> with the multiplier of a next step h: the momentum that leaves q.
  SolveStatus leave(Point& point, double h) const {
    Point next = point;
    const SolveStatus status = step(next, h);
    if (status == SolveStatus::converged) point.p += constraint_at(point.q).gradient.transpose() * next.multipliers;
    return status;
  }

 private:
  static constexpr int size = n + d;
  using Column = Vector<double, size>;
  using Square = Matrix<double, size, size>;
  using Factor = detail::EquilibratedFactor<n, d>;

  struct Constraint {
    Vector<double, d> value;
    Matrix<double, d, n> gradient;
  };
  Constraint constraint_at(const Vector<double, n>& q) const {
    Constraint out;
    if constexpr (d > 0) {
      using J = Jet<double, n>;
      Vector<J, n> seed;
      for (int i = 0; i < n; ++i) seed(i) = J::variable(q(i), i);
      const Vector<J, d> c = function_.constraint(seed);
      for (int i = 0; i < d; ++i) {
        out.value(i) = c(i).value;
        out.gradient.row(i) = c(i).gradient().transpose();
      }
    }
    return out;
  }

  /// The equations in x = q_{k+1} (types I, III) or p_{k+1} (type II) and lambda.
  struct Equations {
    Vector<double, n> q;  ///< q_{k+1}
    Vector<double, n> p;  ///< p_{k+1}
    Column residual;
    double roundoff_ratio;  ///< the largest |residual| over the rounding of its terms
    Square matrix;
    Square reference;  ///< `matrix` with C'(q_k) in place of C'(q_{k+1})
  };
  Equations equations(const Point& point, const Constraint& here, double h, const Column& unknown) const;

  F function_;
};

template <GeneratingFunction F>
auto HamiltonianMap<F>::equations(const Point& point, const Constraint& here, double h, const Column& unknown) const
    -> Equations {
  using J = SecondJet<double, 2 * n>;
  const Vector<double, n> x = unknown.template head<n>();
  const Vector<double, n> reaction = here.gradient.transpose() * unknown.template tail<d>();
  const Vector<double, n> kicked = point.p + reaction;
  const Vector<double, n>& first = F::type == GeneratingType::three ? x : point.q;
  const Vector<double, n>& second = F::type == GeneratingType::three ? kicked : x;
  Vector<J, n> seed_first;
  Vector<J, n> seed_second;
  for (int i = 0; i < n; ++i) {
    seed_first(i) = J::variable(first(i), i);
    seed_second(i) = J::variable(second(i), n + i);
  }
  const J value = function_.generating(seed_first, seed_second, h);
  const Vector<double, 2 * n> gradient = value.gradient();
  const Matrix<double, 2 * n, 2 * n> hessian = value.hessian();
  const Vector<double, n> d1 = gradient.template head<n>();
  const Vector<double, n> d2 = gradient.template tail<n>();
  const Matrix<double, n, n> mixed = hessian.template topRightCorner<n, n>();
  const Matrix<double, n, n> momenta = hessian.template bottomRightCorner<n, n>();

  Equations out;
  Matrix<double, n, n> equation_x;
  Matrix<double, n, d> equation_lambda;
  Matrix<double, n, n> position_x = Matrix<double, n, n>::Identity();
  Vector<double, n> equation;
  Vector<double, n> terms = hessian.template topLeftCorner<n, 2 * n>().cwiseAbs() * joined(first, second).cwiseAbs() +
                            d1.cwiseAbs() + point.p.cwiseAbs() +
                            here.gradient.transpose().cwiseAbs() * unknown.template tail<d>().cwiseAbs();
  if constexpr (F::type == GeneratingType::one) {
    out.q = x;
    out.p = d2;
    equation = kicked + d1;
    equation_x = mixed;
    equation_lambda = here.gradient.transpose();
  } else if constexpr (F::type == GeneratingType::two) {
    out.q = d2;
    out.p = x;
    equation = d1 - kicked;
    equation_x = mixed;
    equation_lambda = -here.gradient.transpose();
    position_x = momenta;
  } else {
    out.q = x;
    out.p = -d1;
    equation = point.q + d2;
    terms = hessian.template bottomLeftCorner<n, 2 * n>().cwiseAbs() * joined(first, second).cwiseAbs() +
            d2.cwiseAbs() + point.q.cwiseAbs();
    equation_x = mixed.transpose();
    equation_lambda = momenta * here.gradient.transpose();
  }
  out.residual.template head<n>() = equation;
  out.matrix.setZero();
  out.matrix.template topLeftCorner<n, n>() = equation_x;
  out.matrix.template topRightCorner<n, d>() = equation_lambda;
  out.reference = out.matrix;
  const auto roundoff_ratio = [](double residual, double of) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    return residual == 0 ? 0 : std::isfinite(of) ? std::abs(residual) / (rounding * of) : INFINITY;
  };
  out.roundoff_ratio = 0;
  for (int i = 0; i < n; ++i) out.roundoff_ratio = std::max(out.roundoff_ratio, roundoff_ratio(equation(i), terms(i)));
  if constexpr (d > 0) {
    const Constraint there = constraint_at(out.q);
    out.residual.template tail<d>() = there.value;
    for (int i = 0; i < d; ++i)
      out.roundoff_ratio = std::max(
          out.roundoff_ratio, roundoff_ratio(there.value(i), there.gradient.row(i).cwiseAbs().dot(out.q.cwiseAbs())));
    out.matrix.template bottomLeftCorner<d, n>() = there.gradient * position_x;
    out.reference.template bottomLeftCorner<d, n>() = here.gradient * position_x;
  }
  return out;
}

template <GeneratingFunction F> SolveStatus HamiltonianMap<F>::step(Point& point, double h) const {
  constexpr int most_iterations = 50;
  constexpr double floor = 100;  // times the rounding of its terms is as far as some residuals get
  const Constraint here = constraint_at(point.q);
  Column unknown = Column::Zero();
  unknown.template head<n>() = F::type == GeneratingType::two ? point.p : point.q;

  Equations at = equations(point, here, h, unknown);
  if (!at.residual.allFinite() || !at.matrix.allFinite()) return SolveStatus::not_finite;
  const bool is_positive = Factor(at.reference).positive();
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Factor factor(at.matrix);
    if (!factor.regular()) return SolveStatus::singular;
    unknown -= factor.solve(at.residual);
    at = equations(point, here, h, unknown);
    if (!unknown.allFinite() || !at.residual.allFinite() || !at.matrix.allFinite()) return SolveStatus::not_finite;
    if (at.roundoff_ratio <= 1 || (at.roundoff_ratio <= floor && at.roundoff_ratio >= last / 2)) {
      const Factor solved(at.matrix);
      if (!solved.regular()) return SolveStatus::singular;
      if (solved.positive() != is_positive) return SolveStatus::left_domain;
      point.q = at.q;
      point.p = at.p;
      if constexpr (d > 0) point.multipliers = unknown.template tail<d>();
      return SolveStatus::converged;
    }
    last = at.roundoff_ratio;
  }
  return SolveStatus::not_converged;
}

/// H_d- after H_d+, each for half a step, or the same of types I and I or III and II: a map and its adjoint, whose
/// product is symmetric on T*Q and of even order, two for r = 0.
template <GeneratingFunction F> class SymmetrisedMap {
 public:
  using Point = typename HamiltonianMap<F>::Point;

  explicit SymmetrisedMap(const F& function) : first_(function), second_(adjoint_of(function)) {}

  /// As HamiltonianMap::step; `multipliers` are those of the second half.
  SolveStatus step(Point& point, double h) const {
    Point next = point;
    if (const SolveStatus status = first_.step(next, h / 2); status != SolveStatus::converged) return status;
    if (const SolveStatus status = second_.step(next, h / 2); status != SolveStatus::converged) return status;
    point = next;
    return SolveStatus::converged;
  }

 private:
  HamiltonianMap<F> first_;
  HamiltonianMap<AdjointFunction<F>> second_;
};

/// The steps gamma_i h of a composition, or none. Of a map that is symmetric on T*Q (RATTLE, SymmetrisedMap) the order
/// is the composition's, in q and in the tangent p; `multipliers` are those of the last step.
template <class Map>
SolveStatus composed_step(const Map& map, typename Map::Point& point, double h, const Composition& composition) {
  typename Map::Point next = point;
  for (const double gamma : composition.coefficients)
    if (const SolveStatus status = map.step(next, gamma * h); status != SolveStatus::converged) return status;
  point = next;
  return SolveStatus::converged;
}

}  // namespace lagroid
