#pragma once
/// A Routhian that was solved for on paper: what a system may offer for a fixed momentum of a symmetry, so that nothing
/// is left to solve at run time.
///
///     routhian(c, b, mu) = ext over theta of  L(c.attach(b, theta)) - <mu, theta>,     theta(b) = -d routhian / d mu
///
/// with c the discrete connection of the level, b an arrow of its base and theta near 0. The angle needs no formula of
/// its own: by the extremum, it is minus the derivative by the momentum.
///
///     template <class S, class T>
///     S routhian(const FactorConnection<Factors<1>, Pair<1>, SO2>&, const PairArrow<S, 1>& b, const Vector<T, 1>& mu)
///         const;
///
/// Required: a function over any scalar of b, with a momentum over the same or of doubles, which is not a number where
/// no angle has that momentum. Where it holds for some parameters alone, `bool has_routhian() const` says whether. A
/// reduced system has the Routhian of the full one (core/reduction/reduced_system.hpp). That it is the right one is a
/// claim: `examine_routhian` (core/reduction/momentum_level.hpp) compares it with Newton's method, as scenes do before
/// they start and `level_laws` do. Errors: none.

#include <lagroid/core/types.hpp>

#include <concepts>

namespace lagroid {

/// For the levels of that connection.
template <class Sys, class Connection>
concept HasRouthian = requires(const Sys& system, const Connection& connection,
                               const typename Connection::Codomain::template Arrow<double>& b,
                               const Vector<double, Connection::angles>& momentum) {
  { system.routhian(connection, b, momentum) } -> std::convertible_to<double>;
};
/// One that holds for some parameters.
template <class Sys>
concept HasRouthianInPart = requires(const Sys& system) {
  { system.has_routhian() } -> std::convertible_to<bool>;
};

}  // namespace lagroid
