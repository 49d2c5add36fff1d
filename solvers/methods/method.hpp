#pragma once
/// What a one-step method z -> Phi_h(z) declares of itself: order, symmetry, symplecticity. Ledgers promise by it, and
/// a test holds each method to its order (laws::order_laws).
///
///     struct Euler : System<Euler, Pair<1>> {
///       double h = 0.1;
///       template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
///         return (g.target - g.source).squaredNorm() * (0.5 / h) - g.source(0) * g.source(0) * (0.5 * h);
///       }
///       MethodTraits traits() const { return {"symplectic Euler", 1, false, true, false}; }
///     };
///
/// A system writes `traits()` where its discretisation is no self-adjoint one of order two, else nothing.

#include <lagroid/core/member_name.hpp>

#include <concepts>
#include <string>

namespace lagroid {

/// The traits of a one-step map z -> Phi_h(z) of A*G.
struct MethodTraits {
  std::string name;
  int order;        ///< the error after a fixed time is O(h^order)
  bool symmetric;   ///< Phi_{-h} o Phi_h is the identity
  bool symplectic;  ///< Phi_h is a Poisson map of A*G; symplectic where that is a cotangent bundle
  bool explicit_;   ///< explicit: no equations are solved
  int stages = 0;  ///< evaluations of a step in closed form (Strang steps, rates); 0 where the solver counts iterations
};

/// A system whose discretisation has other traits than a self-adjoint one of order two: it writes `MethodTraits
/// traits() const`.
template <class Sys>
concept HasTraits = requires(const Sys& system) {
  { system.traits() } -> std::same_as<MethodTraits>;
};
namespace detail {
LAGROID_MEMBER_NAME(NamesTraits, traits);
}  // namespace detail
/// Whether `traits`, where there are any, are those.
template <class Sys> inline constexpr bool traits_fit = HasTraits<Sys> || !detail::NamesTraits<Sys>;

}  // namespace lagroid
