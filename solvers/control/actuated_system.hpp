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
/// scalar, and no object constraints. A force is a covector in A*_qG, in the basis of the momentum. Discrete forces of
/// the system's own act too, and nonholonomic constraints hold: their multipliers follow the controls, unbounded, and
/// momenta are those before the reaction, so that their components along the annihilator should be free at both ends
/// (`free_start`, `free_end`); where these are prescribed, the order in h is one, elsewhere two. Other arrow
/// constraints do not compile. `running_cost` is taken at the states (q, mu) of both ends. Derivatives are third ones
/// of L, exact.
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
struct ActuatedSystem : ControlSystem<Derived, ActuatedGroupoid<Sys>, ControlCount + Sys::arrow_constraints,
                                      2 * Sys::dimension + Sys::arrow_constraints, Inequalities> {
  static_assert(StepDependent<Sys> && !TimeDependent<Sys>, "the system writes lagrangian(g, step) (see StepDependent)");
  static_assert(Sys::object_constraints == 0, "object constraints have multipliers on objects, which are not controls");
  static_assert(Sys::arrow_constraints == 0 || Nonholonomic<Sys>, "arrow constraints are nonholonomic ones");
  using Motion = typename Sys::GroupoidType;
  static constexpr int rank = Sys::dimension;
  static constexpr int reactions = Sys::arrow_constraints;
  static constexpr int all_controls = ControlCount + reactions;
  template <class S> using MotionArrow = ArrowOf<Motion, S>;
  template <class S> using State = lagroid::State<Motion, S>;
  template <class S> using AllControls = Vector<S, all_controls>;

  Sys system;

  template <class A, class S> S cost(const A& g, const AllControls<S>& all, const S& h) const {
    const auto& [arrow, momentum] = g;
    const Vector<S, ControlCount> u = part<0, ControlCount>(all);
    const S ends = self().running_cost(State<S>{system.groupoid.source(arrow), momentum.source}, u) +
                   self().running_cost(State<S>{system.groupoid.target(arrow), momentum.target}, u);
    return ends * h * 0.5;
  }

  template <class A, class S>
  Vector<S, 2 * rank + reactions> constraint(const A& g, const AllControls<S>& all, const S& h) const {
    const auto& [arrow, momentum] = g;
    const Vector<S, ControlCount> u = part<0, ControlCount>(all);
    const auto source = system.groupoid.source(arrow);
    const Vector<S, rank> at_source = self().force(source, u);
    const Vector<S, rank> at_target = self().force(system.groupoid.target(arrow), u);
    const S half = h * 0.5;
    Vector<S, 2 * rank + reactions> out;
    for (int i = 0; i < rank; ++i) {
      out(i) = momentum.source(i) + half * at_source(i) + slope<End::source, S>(arrow, h, i);
      out(rank + i) = slope<End::target, S>(arrow, h, i) + half * at_target(i) - momentum.target(i);
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

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }

  /// dL/dv_i of L(tau(v)^{-1} g), or of L(g tau(v)), at v = 0.
  template <End Which, class S> S slope(const MotionArrow<S>& g, const S& h, int i) const {
    using D = Dual<S>;
    Vector<D, rank> still;
    for (int j = 0; j < rank; ++j) still(j) = D(S(0.0), S(0.0));
    Vector<D, rank> moved = still;
    moved(i).derivative = S(1.0);
    const auto there = system.groupoid.template cast<D>(g);
    const MotionArrow<D> displaced = Which == End::source ? system.groupoid.translate(moved, there, still)
                                                          : system.groupoid.translate(still, there, moved);
    return D(system.lagrangian(displaced, D(h, S(0.0)))).derivative;
  }
};

}  // namespace lagroid
