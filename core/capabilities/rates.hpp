#pragma once
/// The continuous motion that a system discretises, as a vector field on A*G: q' = rho(X) with X = dH/dmu, and mu'.
///
/// Runge-Kutta methods step along it; steps of the discrete Lagrangian do not need it.
///
///     Rates<Pair<1>> rates(const State<Pair<1>>& z) const { return {z.momentum, -z.object}; }
///
/// for H = (p^2 + q^2) / 2.
///
/// Requires a system with a time step `h`. Returns the field in the basis of A_qG. `rates_fit` is false for a member of
/// this name and another form.

#include <lagroid/core/system.hpp>

#include <concepts>

namespace lagroid {

/// Of a motion at (q, mu) in A*G: the velocity X in A_qG, along which objects and arrows move, q' = rho(X) and
/// g' = X<-(g), and mu'.
template <class G> struct Rates {
  AlgebroidVector<G> velocity;
  AlgebroidVector<G> momentum;
};

/// A system that writes `Rates<G> rates(const State<G>& z) const`, the vector field on A*G of which its step is an
/// approximation: X = dH/dmu, mu' = -rho^* dH/dq + ad^*_X mu, and forces or reactions if there are any.
template <class Sys>
concept HasRates = DiscreteSystem<Sys> && HasTimeStep<Sys> &&
    requires(const Sys& system, const State<typename Sys::GroupoidType>& z) {
  { system.rates(z) } -> std::same_as<Rates<typename Sys::GroupoidType>>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesRates, rates);
}  // namespace detail

/// Whether `rates`, where there is one, is that.
template <class Sys> inline constexpr bool rates_fit = HasRates<Sys> || !detail::NamesRates<Sys>;

}  // namespace lagroid
