#pragma once
/// What a system can be reduced by, declared once: scenes, listings and checks read it from here.
///
/// A reduction is a morphism that the system descends along, or a fixed momentum of an Abelian symmetry, each with the
/// name by which users ask for it.
///
///     static auto reductions() {
///       return std::tuple(reduction("rotations", PolarQuotient{}, "rotations about the centre"),
///                         fixed_momentum("angular-momentum", PolarQuotient{},
///                                        FactorConnection<Factors<1>, Pair<1>, SO2>{}, "the radius alone moves"));
///     }
///
/// Requires a public static function of no arguments that returns such a tuple; `for_each_reduction` visits it in
/// order. That the system is invariant is a claim, which is examined before it is used (core/reduction/descent.hpp).
///
/// Errors: `reductions` of another form does not compile. Nothing throws.

#include <lagroid/core/member_name.hpp>

#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// By a morphism: the system on its Codomain (ReducedSystem).
template <class Phi> struct Reduction {
  using Codomain = typename Phi::Codomain;
  std::string_view name;
  Phi along;
  std::string_view meaning;
};
/// In place of a first reduction: none.
struct Unreduced {};
/// At the momentum of the initial state, by a discrete connection (MomentumLevel), of the system or of what it is after
/// a first reduction.
template <class Connection, class First = Unreduced> struct FixedMomentum {
  using Codomain = typename Connection::Codomain;
  std::string_view name;
  Connection connection;
  std::string_view meaning;
  First first = {};
};

/// One declaration of `reductions()`, which lists them in the order in which users read them.
template <class Phi> Reduction<Phi> reduction(std::string_view name, Phi along, std::string_view meaning) {
  return {name, std::move(along), meaning};
}
template <class Connection>
FixedMomentum<Connection> fixed_momentum(std::string_view name, Connection connection, std::string_view meaning) {
  return {name, std::move(connection), meaning, {}};
}
/// After a reduction by a morphism.
template <class Phi, class Connection>
FixedMomentum<Connection, Reduction<Phi>> fixed_momentum(std::string_view name, Phi along, Connection connection,
                                                         std::string_view meaning) {
  return {name, std::move(connection), meaning, {name, std::move(along), meaning}};
}

template <class Sys>
concept HasReductions = requires {
  Sys::reductions();
};

namespace detail {
LAGROID_MEMBER_NAME(NamesReductions, reductions);
template <class T> inline constexpr bool is_reduction = false;
template <class Phi> inline constexpr bool is_reduction<Reduction<Phi>> = true;
template <class Connection, class First> inline constexpr bool is_reduction<FixedMomentum<Connection, First>> = true;
template <class T> inline constexpr bool are_reductions = false;
template <class... Each> inline constexpr bool are_reductions<std::tuple<Each...>> = (is_reduction<Each> && ...);
}  // namespace detail
/// Whether `reductions`, where there are any, are declarations.
template <class Sys> constexpr bool reductions_fit() {
  if constexpr (HasReductions<Sys>) {
    return detail::are_reductions<std::remove_cvref_t<decltype(Sys::reductions())>>;
  } else {
    return !detail::NamesReductions<Sys>;
  }
}

/// Visits the declarations of a system's reductions in order; none where it has none.
template <class Sys, class Visit> void for_each_reduction(const Visit& visit) {
  static_assert(reductions_fit<Sys>(),
                "reductions() is there but does not fit: a public static function of no arguments that returns a "
                "std::tuple of reduction(...) and fixed_momentum(...)");
  if constexpr (HasReductions<Sys> && reductions_fit<Sys>())
    std::apply([&](const auto&... each) { (visit(each), ...); }, Sys::reductions());
}

/// By which users ask for them.
template <class Sys> std::vector<std::string> names_of_reductions() {
  std::vector<std::string> names;
  for_each_reduction<Sys>([&](const auto& declared) { names.emplace_back(declared.name); });
  return names;
}

}  // namespace lagroid
