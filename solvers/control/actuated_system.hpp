#pragma once
/// Optimal control of a discrete system by controlled forces: DMOC, between points (q_k, mu_k) of A*G,
///
///     mu_k + h/2 B(q_k, u_k) = F-(g_k, lambda_k),    F+(g_k, lambda_k) + h/2 B(q_{k+1}, u_k) = mu_{k+1},
///
/// the system's own steps, with half of the control's impulse at either end. Where the forces are zero the trajectory
/// is that of its integrator, and whatever symmetry the forces leave is conserved exactly. The system is written once,
/// as for a simulation.
///
///     struct Driven : ActuatedSystem<Driven, Pendulum, /*controls*/ 1> {
///       template <class Q, class S> Vector<S, 1> force(const Q&, const Vector<S, 1>& u) const { return u; }
///       template <class Z, class S> S running_cost(const Z&, const Vector<S, 1>& u) const { return u(0) * u(0); }
///     };
///
/// Requires a system known for every step size (StepDependent), `force` and `running_cost` as const templates on the
/// scalar, and a start that satisfies object constraints. A force is a covector in A*_qG, in the basis of the momentum.
/// Discrete forces of the system's own act too, and nonholonomic constraints hold: their multipliers follow the
/// controls, unbounded, and momenta are those before the reaction, so that their components along the annihilator
/// should be free at both ends (`free_start`, `free_end`); where these are prescribed, the order in h is one, elsewhere
/// two. Other arrow constraints do not compile. Object constraints C(q_k) = 0 hold at every node, their multipliers are
/// controls behind these, and momenta are those before their reaction, too: at an end the component along dC is to be
/// free. `running_cost`, or `weights` in its place, is taken at the states (q, mu) of both ends. Derivatives are third
/// ones of L, exact.
///
/// Ober-Bloebaum, Junge, Marsden, ESAIM COCV 17 (2011), section 3; [G] Def. 3.3.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/derivatives/annihilator.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/control/control_system.hpp>

#include <tuple>

namespace lagroid {

template <class Sys> using ActuatedGroupoid = Product<typename Sys::GroupoidType, Pair<Sys::dimension>>;

template <class Derived, class Sys, int ControlCount, int Inequalities = 0>
struct ActuatedSystem
    : ControlSystem<Derived, ActuatedGroupoid<Sys>, ControlCount + Sys::arrow_constraints + Sys::object_constraints,
                    2 * Sys::dimension + Sys::arrow_constraints, Inequalities>,
      WeighedCost<Derived, ControlCount> {
  static_assert(StepDependent<Sys> && !TimeDependent<Sys>, "the system writes lagrangian(g, step) (see StepDependent)");
  static_assert(Sys::arrow_constraints == 0 || Nonholonomic<Sys>, "arrow constraints are nonholonomic ones");
  using Motion = typename Sys::GroupoidType;
  static constexpr int rank = Sys::dimension;
  static constexpr int reactions = Sys::arrow_constraints;
  static constexpr int ties = Sys::object_constraints;
  static constexpr int node_equalities = ties;
  static constexpr int all_controls = ControlCount + reactions + ties;
  template <class S> using MotionArrow = ArrowOf<Motion, S>;
  template <class S> using State = lagroid::State<Motion, S>;
  template <class S> using AllControls = Vector<S, all_controls>;

  Sys system;

  template <class A, class S> S cost(const A& g, const AllControls<S>& all, const S& h) const {
    const auto& [arrow, momentum] = g;
    const Vector<S, ControlCount> u = part<0, ControlCount>(all);
    const S ends = this->cost_rate(State<S>{system.groupoid.source(arrow), momentum.source}, u) +
                   this->cost_rate(State<S>{system.groupoid.target(arrow), momentum.target}, u);
    return ends * h * 0.5;
  }

  template <class A, class S>
  Vector<S, 2 * rank + reactions> constraint(const A& g, const AllControls<S>& all, const S& h) const {
    Vector<S, 2 * rank + reactions> out = without_slopes(g, all, h);
    const Vector<S, rank> none = Vector<S, rank>::Constant(S(0.0));
    for (int i = 0; i < rank; ++i) {
      Vector<S, rank> one = none;
      one(i) = S(1.0);
      out(i) += slope(std::get<0>(g), all, h, one, none);
      out(rank + i) += slope(std::get<0>(g), all, h, none, one);
    }
    return out;
  }
  /// <lambda, constraint>: all derivatives of L that are in it at once, along lambda.
  template <class A, class S>
  S weighted_constraint(const A& g, const AllControls<S>& all, const S& h, const double* lambda) const {
    const Vector<S, 2 * rank + reactions> rest = without_slopes(g, all, h);
    Vector<S, rank> source;
    Vector<S, rank> target;
    S sum = rest(0) * lambda[0];
    for (int i = 1; i < 2 * rank + reactions; ++i) sum += rest(i) * lambda[i];
    for (int i = 0; i < rank; ++i) {
      source(i) = S(lambda[i]);
      target(i) = S(lambda[rank + i]);
    }
    return sum + slope(std::get<0>(g), all, h, source, target);
  }
  template <class S, class Q>
  Vector<S, ties> node_constraint(const std::tuple<Q, Vector<S, rank>>& state) const requires(ties > 0) {
    return system.object_constraint(std::get<0>(state));
  }

  /// Gives the nodes between the ends the momenta with which the arrows leave and reach them, in the mean: a trajectory
  /// to start from that lacks nothing but its controls.
  void settle(ControlTrajectory<Derived>& path) const {
    using Momentum = Vector<double, rank>;
    const Momentum none = Momentum::Zero();
    const AllControls<double> at_rest = AllControls<double>::Zero();
    for (std::size_t k = 1; k < path.arrows.size(); ++k) {
      auto& [before, reached] = path.arrows[k - 1];
      auto& [after, left] = path.arrows[k];
      for (int i = 0; i < rank; ++i)
        reached.target(i) = 0.5 * (slope(before, at_rest, path.step(long(k) - 1), none, Momentum(Momentum::Unit(i))) -
                                   slope(after, at_rest, path.step(long(k)), Momentum(Momentum::Unit(i)), none));
      left.source = reached.target;
    }
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }

  /// The equations without derivatives of L and of object constraints.
  template <class A, class S>
  Vector<S, 2 * rank + reactions> without_slopes(const A& g, const AllControls<S>& all, const S& h) const {
    const auto& [arrow, momentum] = g;
    const Vector<S, ControlCount> u = part<0, ControlCount>(all);
    const auto source = system.groupoid.source(arrow);
    const Vector<S, rank> at_source = self().force(source, u);
    const Vector<S, rank> at_target = self().force(system.groupoid.target(arrow), u);
    const S half = h * 0.5;
    Vector<S, 2 * rank + reactions> out;
    for (int i = 0; i < rank; ++i) {
      out(i) = momentum.source(i) + half * at_source(i);
      out(rank + i) = half * at_target(i) - momentum.target(i);
    }
    if constexpr (Forced<Sys>) {
      const Forces<S, rank> own = system.forces(arrow, h);
      for (int i = 0; i < rank; ++i) {
        out(i) += own.source(i);
        out(rank + i) += own.target(i);
      }
    }
    if constexpr (reactions > 0) {
      const Matrix<S, rank, reactions> omega = annihilator<Sys, S>(system, source);
      const Vector<S, reactions> phi = system.constraint(arrow, h);
      for (int a = 0; a < reactions; ++a) {
        for (int i = 0; i < rank; ++i) out(i) += omega(i, a) * all(ControlCount + a);
        out(2 * rank + a) = phi(a);
      }
    }
    return out;
  }
  /// d/de (L(g') + <kappa, C(q')>) at e = 0, g' = tau(e a)^{-1} g tau(e b) from q' on, kappa the multipliers of the
  /// object constraints.
  template <class S>
  S slope(const MotionArrow<S>& g, const AllControls<S>& all, const S& h, const Vector<S, rank>& a,
          const Vector<S, rank>& b) const {
    using D = Dual<S>;
    Vector<D, rank> at_source;
    Vector<D, rank> at_target;
    for (int i = 0; i < rank; ++i) {
      at_source(i) = D(S(0.0), a(i));
      at_target(i) = D(S(0.0), b(i));
    }
    const MotionArrow<D> displaced =
        system.groupoid.translate(at_source, system.groupoid.template cast<D>(g), at_target);
    S out = D(system.lagrangian(displaced, D(h, S(0.0)))).derivative;
    if constexpr (ties > 0) {
      const Vector<D, ties> c = system.object_constraint(system.groupoid.source(displaced));
      for (int k = 0; k < ties; ++k) out += c(k).derivative * all(ControlCount + reactions + k);
    }
    return out;
  }
};

}  // namespace lagroid
