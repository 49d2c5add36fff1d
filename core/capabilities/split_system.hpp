#pragma once
/// Systems whose energy is a sum H = H_0 + ... + H_{k-1} of parts that can be integrated in closed form.
///
/// Compositions of the exact flows of the parts are explicit symplectic methods of any order.
///
///     static constexpr int parts = 2;  // kinetic, then potential
///     template <int I, class S, class T>
///     FlowOf<Pair<1>, S> flow(const T& t, const Vector<S, 1>& q, const Vector<S, 1>& p) const {
///       if constexpr (I == 0) return {{q, q + p * t}, p * 0.0};
///       return {{q, q}, q * -t};
///     }
///
/// Requires flows that are exact, for t of either sign, on a system without forces and arrow constraints (see
/// `SplitSystem`). Returns the arrow along which a flow leads and the change of the momentum. Nothing throws.

#include <lagroid/core/system.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace lagroid {

/// The way that a point (q, mu) of A*G goes along a flow: an arrow from q, and mu' - mu at its target.
template <class Arrow, class S, int N> struct Flow {
  Arrow arrow;
  Vector<S, N> momentum_change;
  /// What rounding took of the arrow, g tau(remainder), where the flow knows it.
  Vector<S, N> remainder = Vector<S, N>::Constant(S(0.0));
};
template <class G, class S = double> using FlowOf = Flow<typename G::template Arrow<S>, S, G::dimension>;

namespace detail {

template <class Sys, int I>
concept HasFlow = requires(const Sys& system, const State<typename Sys::GroupoidType>& z) {
  { system.template flow<I>(1.0, z.object, z.momentum) } -> std::same_as<FlowOf<typename Sys::GroupoidType>>;
};

template <class Sys> constexpr bool has_flows() {
  return []<int... I>(std::integer_sequence<int, I...>) { return (HasFlow<Sys, I> && ...); }
  (std::make_integer_sequence<int, Sys::parts>{});
}

}  // namespace detail

/// A system without forces or constraints on arrows whose energy is H = H_0 + ... + H_{parts - 1}. It writes
///
///     static constexpr int parts
///     template <int I, class S, class T> FlowOf<G, S> flow(const T& t, const Object<S>& q, const Vector<S, n>& mu)
///     const
///
/// T is double, or S where S is a number for each lane of a register (SplitInLanes); with `double t` in its place the
/// latter is not there for those who could use it, which are slower then.
///
/// Invariants (checked by tests, not by the compiler): flow<I>(t, z) follows the Hamiltonian vector field of H_I on A*G
/// for the time t, of either sign, exactly: q' = rho(dH_I/dmu), mu' = -rho^* dH_I/dq + ad^*_{dH_I/dmu} mu; its arrow is
/// that from q which the section dH_I/dmu leads along, g' = X<-(g). Hence flow<I> is a Poisson map, a flow in t, keeps
/// H_I, and any composition of flows is Poisson and keeps the momenta of the symmetries that all parts share. With
/// object constraints all of this is meant of T*C^{-1}(0), where the flows stay.
///
/// It may also write `bool two_flows() const`, whether all flows but the first and the last do nothing (of two flows:
/// always), and `static constexpr bool nystrom = true` where H_0 does not depend on momenta and the others are
/// quadratic in them.
template <class Sys>
concept SplitSystem = DiscreteSystem<Sys> && Variational<Sys> && Sys::arrow_constraints == 0 &&
                      HasTimeStep<Sys>&& Sys::parts >= 1 && detail::has_flows<Sys>();

/// A split system whose flows take a time of their own in each lane of S.
template <class Sys, class S>
concept SplitInLanes = SplitSystem<Sys> &&
    requires(const Sys& system, const S& t, const ObjectOf<typename Sys::GroupoidType, S>& q,
             const Vector<S, Sys::dimension>& mu) {
  system.template flow<0>(t, q, mu);
  system.template flow<Sys::parts - 1>(t, q, mu);
};

template <class Sys>
concept NystromSystem = SplitSystem<Sys> && requires {
  requires Sys::nystrom;
};

/// A system of two flows, of a potential and of a kinetic energy, that writes
///
///     double kinetic_energy(const AlgebroidVector<G>& mu) const
///     double potential_energy(const Object<double>& q) const        negative wherever the motion goes
///
/// and declares `static constexpr bool attractive = true`. Derivatives of runs want both as templates on the scalar.
template <class Sys>
concept AttractiveSystem = SplitSystem<Sys> && Sys::parts == 2 &&
                           requires(const Sys& system, const State<typename Sys::GroupoidType>& z) {
  requires Sys::attractive;
  { system.kinetic_energy(z.momentum) } -> std::convertible_to<double>;
  { system.potential_energy(z.object) } -> std::convertible_to<double>;
};

namespace detail {

template <class Sys>
concept CountsParts = requires {
  requires std::same_as<decltype(Sys::parts), const int>;
  requires Sys::parts >= 1;
};
LAGROID_MEMBER_NAME(NamesParts, parts);
LAGROID_MEMBER_NAME(NamesFlow, flow);
template <class Sys> constexpr bool counted_flows_fit() {
  if constexpr (CountsParts<Sys>) {
    return HasTimeStep<Sys> && has_flows<Sys>();
  } else {
    return false;
  }
}

}  // namespace detail

/// Whether the flows, where there are any, are those. (A system derived from one that splits, with forces of its own,
/// has flows and no use for them.)
template <class Sys>
inline constexpr bool flows_fit =
    !(detail::NamesParts<Sys> || detail::NamesFlow<Sys>) || detail::counted_flows_fit<Sys>();
/// Whether a system that declares itself attractive, and could be, is.
template <class Sys> inline constexpr bool attraction_fits = AttractiveSystem<Sys> || !Variational<Sys> || !requires {
  requires Sys::attractive;
};

}  // namespace lagroid
