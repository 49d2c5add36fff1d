#pragma once
/// A system run backwards: L(g^{-1}) with the constraints on g^{-1}.
///
/// A step of it from (q', -mu') leads to (q, -mu) where a step of the system leads from (q, mu) to (q', mu'): a test of
/// solvers, and a way back.
///
///     const Reversed<Sys> backwards(system);
///     const double value = backwards.lagrangian(g);  // L(g^{-1})
///
/// Requires a variational system (else it does not compile). Nothing throws.

#include <lagroid/core/system.hpp>

namespace lagroid {

/// L(g^{-1}) with the constraints on g^{-1}: (g, lambda) solves the step of `forward` from (q, mu) to (q', mu') exactly
/// when (g^{-1}, lambda) solves the step of this system from (q', -mu') to (q, -mu). (With object constraints lambda
/// belongs to the object a step starts from, here q', and momenta agree up to multiples of dC o rho.)
template <class Sys>
struct Reversed : System<Reversed<Sys>, typename Sys::GroupoidType, Sys::arrow_constraints, Sys::object_constraints> {
  static_assert(Variational<Sys>);
  using MembersVary = void;
  Sys forward;

  explicit Reversed(const Sys& system) : forward(system) { this->groupoid = system.groupoid; }

  template <class A> auto lagrangian(const A& g) const { return forward.lagrangian(this->groupoid.inverse(g)); }
  template <class A> auto constraint(const A& g) const requires(Sys::arrow_constraints > 0) {
    return forward.constraint(this->groupoid.inverse(g));
  }
  template <class Q> auto object_constraint(const Q& q) const requires(Sys::object_constraints > 0) {
    return forward.object_constraint(q);
  }
  bool admissible(const ArrowOf<typename Sys::GroupoidType>& g) const requires HasBranch<Sys> {
    return forward.admissible(this->groupoid.inverse(g));
  }
};

}  // namespace lagroid
