#pragma once
/// The adjoint of a discretisation: Phi*_h = (Phi_{-h})^{-1}, of the Lagrangian L*(g, h) = -L(g^{-1}, -h).
///
/// A step followed by its adjoint, Phi_{h/2} o Phi*_{h/2}, is symmetric, and so of even order.
///
///     WithAdjoint<Sys> both(system);
///     both.adjoint = true;
///     const double value = both.lagrangian(g, both.h);  // -L(g^{-1}, -h)
///
/// Requires a system that takes the step size as an argument (StepDependent). Nothing throws.

#include <lagroid/core/capabilities/stepped.hpp>

#include <utility>

namespace lagroid {

/// A discretisation or, on demand, its adjoint L*(g, h) = -L(g^{-1}, -h), phi*(g, h) = -phi(g^{-1}, -h), whose step is
/// Phi*_h = (Phi_{-h})^{-1}: (g, lambda) solves it exactly when (g^{-1}, lambda) solves the step of L over -h. A step
/// is symmetric when it is its own adjoint; Phi_{h/2} o Phi*_{h/2} always is, and so of even order where Phi is of
/// order one.
template <StepDependent Sys>
struct WithAdjoint
    : System<WithAdjoint<Sys>, typename Sys::GroupoidType, Sys::arrow_constraints, Sys::object_constraints> {
  Sys forward;
  double h;
  bool adjoint = false;

  explicit WithAdjoint(Sys system) : forward(std::move(system)), h(forward.h) { this->groupoid = forward.groupoid; }

  template <class A, class T> auto lagrangian(const A& g, const T& step) const {
    using S = decltype(forward.lagrangian(g, step));
    return adjoint ? S(-forward.lagrangian(this->groupoid.inverse(g), T(-step))) : forward.lagrangian(g, step);
  }
  template <class A> auto lagrangian(const A& g) const { return lagrangian(g, h); }
  template <class A, class T> auto constraint(const A& g, const T& step) const requires(Sys::arrow_constraints > 0) {
    auto c = forward.constraint(adjoint ? this->groupoid.inverse(g) : g, adjoint ? T(-step) : step);
    if (adjoint) c = (-c).eval();
    return c;
  }
  template <class A> auto constraint(const A& g) const requires(Sys::arrow_constraints > 0) { return constraint(g, h); }
  template <class Q> auto object_constraint(const Q& q) const requires(Sys::object_constraints > 0) {
    return forward.object_constraint(q);
  }
};

}  // namespace lagroid
