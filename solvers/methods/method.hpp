#pragma once
/// What a one-step method declares of itself; tests hold it to its order (laws::order_laws).

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
