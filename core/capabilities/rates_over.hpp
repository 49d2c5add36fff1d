#pragma once
/// Rates (rates.hpp) over any scalar: what a system writes whose Runge-Kutta steps are to be differentiated.
///
///     template <class S = double> RatesOver<Pair<1>, S> rates(const State<Pair<1>, S>& z) const {
///       return {z.momentum / varied<S>(mass), z.object * -varied<S>(stiffness)};
///     }
///
/// Requires nothing. Over doubles these are Rates<G>. Nothing throws.

#include <lagroid/core/capabilities/rates.hpp>
#include <lagroid/core/derivatives/varied_directions.hpp>

#include <concepts>
#include <type_traits>

namespace lagroid {

/// The velocity X in A_qG and mu', over a scalar with derivatives.
template <class G, class S> struct ScalarRates {
  AlgebroidVector<G, S> velocity;
  AlgebroidVector<G, S> momentum;
};
template <class G, class S = double>
using RatesOver = std::conditional_t<std::is_same_v<S, double>, Rates<G>, ScalarRates<G, S>>;

/// A system whose rates are known with their derivatives.
template <class Sys>
concept HasVariedRates = HasRates<Sys> &&
    requires(const Sys& system, const State<typename Sys::GroupoidType, VariedNumber>& z) {
  { system.rates(z) } -> std::same_as<RatesOver<typename Sys::GroupoidType, VariedNumber>>;
};

}  // namespace lagroid
