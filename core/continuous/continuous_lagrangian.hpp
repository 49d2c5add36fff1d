#pragma once
/// A continuous Lagrangian l : AG -> R on the Lie algebroid of a groupoid, with arrow constraints psi(q, xi) = 0,
/// AG -> R^m, and object constraints C(q) = 0: what is discretised by a rule, of whatever order.
///
/// A mechanical system is known by its energies and velocities; rules make discrete systems of it, so that the order is
/// the choice of whoever computes and not of whoever writes the formula.
///
///     struct Pendulum : ContinuousLagrangian<Pair<1>> {
///       template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
///         using std::cos;
///         return v(0) * v(0) * 0.5 + cos(q(0));
///       }
///     };
///     inline const Galerkin<Pendulum, 4> system{Pendulum{}, /*h*/ 0.1};  // of order eight
///
/// Requires const templates on the scalar. q is an object of G, xi the velocity in A_qG in the basis that the
/// retraction fixes there: q' on the pair groupoid, the body velocity on a Lie group. Parameters are declared as a
/// system declares them (`parameters()`, core/parameter.hpp).
///
/// Errors: an l or psi that does not fit does not compile, and the message says what is wanted. Nothing throws.
///
/// Source: [G] section 3 for what is made of it; Martinez, *Lagrangian mechanics on Lie algebroids*, Acta Appl. Math.
/// 67 (2001).

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/system.hpp>

#include <concepts>

namespace lagroid {

/// Base of continuous Lagrangians. The derived class writes
///
///     S l(const Object<S>& q, const Velocity<S>& xi) const
///     Vector<S, ArrowConstraints> psi(const Object<S>& q, const Velocity<S>& xi) const      if there are any
///     Vector<S, ObjectConstraints> object_constraint(const Object<S>& q) const              if there are any
///
/// psi restricts the paths that compete (Principle::vakonomic): the action is critical among those with psi = 0.
/// The class may write, for ledgers and laws, the symmetries of whatever is made of it:
///
///     template <class Sys> std::vector<Symmetry<Sys>> symmetries_of() const
template <class G, int ArrowConstraints = 0, int ObjectConstraints = 0> struct ContinuousLagrangian {
  using GroupoidType = G;
  template <class S> using Object = typename G::template Object<S>;
  template <class S> using Velocity = Vector<S, G::dimension>;
  static constexpr int dimension = G::dimension;
  static constexpr int arrow_constraints = ArrowConstraints;
  static constexpr int object_constraints = ObjectConstraints;
};

namespace detail {

template <class L>
concept HasVelocityLagrangian = requires(const L& lagrangian, const ObjectOf<typename L::GroupoidType>& q,
                                         const AlgebroidVector<typename L::GroupoidType>& xi) {
  { lagrangian.l(q, xi) } -> std::convertible_to<double>;
};
template <class L>
concept HasVelocityConstraint = requires(const L& lagrangian, const ObjectOf<typename L::GroupoidType>& q,
                                         const AlgebroidVector<typename L::GroupoidType>& xi) {
  { lagrangian.psi(q, xi) } -> ColumnOf<L::arrow_constraints>;
};

}  // namespace detail

/// What rules discretise.
template <class L>
concept Continuous = Groupoid<typename L::GroupoidType> && detail::HasVelocityLagrangian<L> &&
    (L::arrow_constraints == 0 || detail::HasVelocityConstraint<L>);

/// What has a Hamiltonian beside it, H(q, mu) (continuous_hamiltonian.hpp).
template <class L>
concept HasHamiltonian = requires(const L& system, const ObjectOf<typename L::GroupoidType>& q,
                                  const AlgebroidVector<typename L::GroupoidType>& mu) {
  { system.hamiltonian(q, mu) } -> std::convertible_to<double>;
};

/// Does not compile where l or psi is not that of a ContinuousLagrangian.
template <class L> constexpr void require_continuous() {
  static_assert(
      detail::HasVelocityLagrangian<L>,
      "l(q, xi) does not fit: a const template on the scalar, S l(const Object<S>& q, const Velocity<S>& xi), "
      "of an object and a velocity of the groupoid (see ContinuousLagrangian)");
  static_assert(L::arrow_constraints == 0 || detail::HasVelocityConstraint<L>,
                "psi(q, xi) does not fit ArrowConstraints: a const template on the scalar that returns as many "
                "components as the base class counts (see ContinuousLagrangian)");
}

}  // namespace lagroid
