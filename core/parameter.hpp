#pragma once
/// The parameters of a system, declared once: scenes, listings, Python and tables read them from here.
///
/// A parameter is a member of the system with a name, a unit, a meaning and a rule, so that a wrong value is refused in
/// words wherever it was given.
///
///     static auto parameters() {
///       return std::tuple(parameter("mass", &Pendulum::bob_mass, "kg", "of the bob", positive),
///                         choice("quadrature", &Pendulum::quadrature, quadrature_words, "of the potential"));
///     }
///
/// Requires a public static function of no arguments that returns such a tuple; `for_each_parameter` visits it in
/// order. Default values are those of the system's constructor. Values are checked by whoever reads them; `refusal_of`
/// returns why a combination of them is refused, or nothing.
///
/// Errors: a `parameters` or `refused` of another form does not compile. Nothing throws.

#include <lagroid/core/member_name.hpp>

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

namespace lagroid {

/// A condition on a number, and the words for it in messages.
struct NumberRule {
  std::string_view words;
  bool (*holds)(double);
};
inline constexpr NumberRule any_number{"a finite number", [](double) { return true; }};
inline constexpr NumberRule positive{"positive", [](double x) { return x > 0; }};
inline constexpr NumberRule nonnegative{"zero or positive", [](double x) { return x >= 0; }};

/// A member of a system that its user sets: a number, or a vector of them. The scalar of the member need not be
/// double. `Owner` may be a base of the system. A direction is a vector of which the length does not count: it is
/// normalised, and not zero.
template <class Owner, class Member> struct Parameter {
  std::string_view name;
  Member Owner::*member;
  std::string_view unit;
  std::string_view meaning;
  NumberRule rule = any_number;
  bool required = false;   ///< whether a scene must give it; else it is what the system's constructor makes of it
  bool direction = false;  ///< of a vector
};

/// A member of enumeration type; `words` name its values 0, 1, ... in order.
template <class Owner, class Enum, std::size_t N> struct Choice {
  std::string_view name;
  Enum Owner::*member;
  std::array<std::string_view, N> words;
  std::string_view meaning;
};

/// One declaration of `parameters()`, which lists them in the order in which users read them.
template <class Owner, class Member>
constexpr Parameter<Owner, Member> parameter(std::string_view name, Member Owner::*member, std::string_view unit,
                                             std::string_view meaning, const NumberRule& rule = any_number) {
  return {name, member, unit, meaning, rule};
}
/// A parameter that scenes must give.
template <class Owner, class Member> constexpr Parameter<Owner, Member> required(Parameter<Owner, Member> parameter) {
  parameter.required = true;
  return parameter;
}
/// A vector of unit length.
template <class Owner, class Member>
constexpr Parameter<Owner, Member> direction(std::string_view name, Member Owner::*member, std::string_view meaning) {
  return {name, member, "1", meaning, any_number, false, true};
}
template <class Owner, class Enum, std::size_t N>
constexpr Choice<Owner, Enum, N> choice(std::string_view name, Enum Owner::*member,
                                        const std::array<std::string_view, N>& words, std::string_view meaning) {
  static_assert(std::is_enum_v<Enum>);
  return {name, member, words, meaning};
}

template <class Sys>
concept HasParameters = requires {
  Sys::parameters();
};

namespace detail {
LAGROID_MEMBER_NAME(NamesParameters, parameters);
LAGROID_MEMBER_NAME(NamesRefused, refused);
template <class T> inline constexpr bool is_declaration = false;
template <class Owner, class Member> inline constexpr bool is_declaration<Parameter<Owner, Member>> = true;
template <class Owner, class Enum, std::size_t N> inline constexpr bool is_declaration<Choice<Owner, Enum, N>> = true;
template <class T> inline constexpr bool are_declarations = false;
template <class... Each> inline constexpr bool are_declarations<std::tuple<Each...>> = (is_declaration<Each> && ...);
}  // namespace detail
/// Whether `parameters`, where there are any, are declarations.
template <class Sys> constexpr bool parameters_fit() {
  if constexpr (HasParameters<Sys>) {
    return detail::are_declarations<std::remove_cvref_t<decltype(Sys::parameters())>>;
  } else {
    return !detail::NamesParameters<Sys>;
  }
}

/// Visits the declarations of a system's parameters in order; none where it has none.
template <class Sys, class Visit> void for_each_parameter(const Visit& visit) {
  static_assert(parameters_fit<Sys>(),
                "parameters() is there but does not fit: a public static function of no arguments that returns a "
                "std::tuple of parameter(...) and choice(...)");
  if constexpr (HasParameters<Sys> && parameters_fit<Sys>())
    std::apply([&](const auto&... each) { (visit(each), ...); }, Sys::parameters());
}

/// Why parameters that are allowed one by one are not allowed together. A system that has such parameters writes
///
///     std::optional<Refusal> refused() const
///
/// which returns nothing where they are allowed.
struct Refusal {
  std::vector<std::string_view> parameters;  ///< the first of them that was given is to blame
  std::string why;
};
/// Refuses a product of parameters that overflows, or is too small to keep its digits.
std::optional<Refusal> refuse_lost_digits(std::vector<std::string_view> parameters, const std::string& product,
                                          double value);

template <class Sys> std::optional<Refusal> refusal_of(const Sys& system) {
  constexpr bool refuses = requires {
    { system.refused() } -> std::convertible_to<std::optional<Refusal>>;
  };
  static_assert(refuses || !detail::NamesRefused<Sys>,
                "refused() is there but does not fit: a public const function that returns std::optional<Refusal>");
  if constexpr (refuses) {
    return system.refused();
  } else {
    return std::nullopt;
  }
}

}  // namespace lagroid
