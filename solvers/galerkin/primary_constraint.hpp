#pragma once
/// Steps of Lagrangians that are linear in the velocities, l = <theta(q), v> - H(q), which keep the primary constraint
/// p = theta(q) at every node.
///
/// Their momenta are functions of the place, so that a discrete Euler-Lagrange equation, of second order, has solutions
/// that the continuous equations (d theta) v = -dH do not have: parasites, which oscillate from node to node and grow.
/// A step here begins and ends where p = theta(q), by a displacement along the constraint's Hamiltonian field, the same
/// at both ends with opposite sign,
///
///     q0~ = q0 + mu,  p0~ = theta(q0) + theta'(q0)^T mu,    p0~ = -D1 L(q0~, q1~),  p1~ = D2 L(q0~, q1~),
///     q1 = q1~ - mu,  theta(q1) = p1~ - theta'(q1)^T mu.
///
/// It is symmetric, so that its energies do not drift where the motion is reversible or integrable; p = theta(q) holds
/// by its definition.
///
///     struct Drift : ContinuousLagrangian<Pair<2>> {  // theta = B (-y, x) / 2, H a well
///       template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
///         return (q(0) * v(1) - q(1) * v(0)) * 0.5 - q(0) * q(0) * 0.5 - q(1) * q(1);
///       }
///     };
///     const PrimaryConstraintStep<Midpoint<Drift>> step{Midpoint<Drift>{}};
///     auto z = step.on(Vector<double, 2>(1, 0));
///     const SolveStatus status = step.step(z, /*h*/ 0.1);
///
/// Requires an l that is linear in v on R^n, without constraints, and a rule of order two, Midpoint or Trapezoidal;
/// composed_step (hamiltonian_map.hpp) makes orders four, six and eight of it.
///
/// Errors: `singular` where d theta cannot be inverted or l is not linear in v, so that momenta are no function of the
/// place; `not_finite`, `not_converged`. The state stays as it was unless the step converged.
///
/// Source: Kraus, *Projected variational integrators for degenerate Lagrangian systems* (2017), arXiv 1708.07356, the
/// symmetric projection.

#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/solvers/status.hpp>

#include <Eigen/LU>

#include <type_traits>
#include <utility>

namespace lagroid {

template <class Rule> class PrimaryConstraintStep {
 public:
  using L = typename Rule::Continuous;
  static constexpr int n = L::dimension;
  using Point = State<Pair<n>>;
  static_assert(std::is_same_v<typename L::GroupoidType, Pair<n>>, "momenta as functions of the place, on R^n");
  static_assert(L::arrow_constraints == 0 && L::object_constraints == 0, "of Lagrangians without constraints");

  explicit PrimaryConstraintStep(Rule rule) : rule_(std::move(rule)) {}

  /// Of order two, symmetric, and no Poisson map: its displacements depend on the step.
  static MethodTraits traits() { return {"projected " + Rule::traits().name, 2, true, false, false}; }

  /// theta(q).
  template <class S> Vector<S, n> momentum(const Vector<S, n>& q) const {
    const auto at = constants<Dual<S>>(q);
    return gradient_of([&](const Vector<Dual<S>, n>& v) { return rule_.l(at, v); },
                       constants<S>(Vector<double, n>(Vector<double, n>::Zero())));
  }
  Point on(const Vector<double, n>& q) const { return {q, momentum(q)}; }
  /// H(q), which is bounded along a motion.
  double energy(const Vector<double, n>& q) const { return -rule_.l(q, Vector<double, n>(Vector<double, n>::Zero())); }

  /// A step h of either sign from q; the momentum of `point` is not asked for.
  SolveStatus step(Point& point, double h) const {
    const auto theta = [this]<class S>(const Vector<S, n>& q) { return this->momentum(q); };
    // (theta' - theta'^T) v = dl/dq at rest: the velocity.
    const Matrix<double, n, n> slope = jacobian_of<n>(theta, point.object);
    const Vector<double, n> force = gradient_of(
        [this](const Vector<Dual<double>, n>& q) {
          return rule_.l(q, constants<Dual<double>>(Vector<double, n>(Vector<double, n>::Zero())));
        },
        point.object);
    if (!slope.allFinite() || !force.allFinite()) return SolveStatus::not_finite;
    const Eigen::FullPivLU<Matrix<double, n, n>> form(slope - slope.transpose());
    if (!form.isInvertible()) return SolveStatus::singular;
    const Vector<double, n> velocity = form.solve(force);
    if (!is_linear(point.object, velocity)) return SolveStatus::singular;

    // In mu and q1~.
    const auto residual = [&]<class U>(const Vector<U, 2 * n>& unknown, const Vector<U, n>& q0) {
      const Vector<U, n> mu = part<0, n>(unknown);
      const Vector<U, n> to = part<n, n>(unknown);
      Vector<U, n> from, q1;
      for (int i = 0; i < n; ++i) {
        from(i) = q0(i) + mu(i);
        q1(i) = to(i) - mu(i);
      }
      const Vector<U, 2 * n> both = joined(from, to);
      const Vector<U, 2 * n> slopes = gradient_of(
          [&](const Vector<Dual<U>, 2 * n>& x) {
            return rule_.lagrangian(PairArrow<Dual<U>, n>{part<0, n>(x), part<n, n>(x)}, h);
          },
          both);
      const Vector<U, n> start = displaced_momentum(q0, mu);
      const Vector<U, n> end = displaced_momentum(q1, mu);
      Vector<U, 2 * n> out;
      for (int i = 0; i < n; ++i) {
        out(i) = start(i) + slopes(i);
        out(n + i) = end(i) - slopes(n + i);
      }
      return out;
    };
    Vector<double, 2 * n> guess;
    guess << Vector<double, n>::Zero(), point.object + h * velocity;
    const Vector<double, 2 * n> found = solve_implicit<double, 2 * n, n>(residual, guess, point.object);
    if (!found.allFinite()) return SolveStatus::not_converged;
    point = on(found.template tail<n>() - found.template head<n>());
    return SolveStatus::converged;
  }

 private:
  /// theta(q) + theta'(q)^T mu.
  template <class U> Vector<U, n> displaced_momentum(const Vector<U, n>& q, const Vector<U, n>& mu) const {
    const auto along = constants<Dual<U>>(mu);
    const Vector<U, n> turned = gradient_of(
        [&](const Vector<Dual<U>, n>& x) {
          const Vector<Dual<U>, n> p = momentum(x);
          Dual<U> sum(U(0.0));
          for (int i = 0; i < n; ++i) sum += p(i) * along(i);
          return sum;
        },
        q);
    Vector<U, n> out = momentum(q);
    for (int i = 0; i < n; ++i) out(i) += turned(i);
    return out;
  }
  /// Whether dl/dv is the same in motion as at rest, at this velocity and at one in every direction.
  bool is_linear(const Vector<double, n>& q, const Vector<double, n>& v) const {
    const auto at = constants<Dual<double>>(q);
    const Vector<double, n> resting = momentum(q);
    for (int i = -1; i < n; ++i) {
      const Vector<double, n> moving = gradient_of([&](const Vector<Dual<double>, n>& x) { return rule_.l(at, x); },
                                                   i < 0 ? v : unit_vector<double, n>(i));
      if (!((moving - resting).norm() <= 1e-12 * (moving.norm() + resting.norm()))) return false;
    }
    return true;
  }

  Rule rule_;
};

}  // namespace lagroid
