#pragma once
/// The numbers among the declared parameters of a system, each under its own name: a vector's by their places.
///
/// Whoever varies, prints or changes parameters visits numbers; what a system declares are members.
///
///     std::vector<std::string> names;  // mass, inertia.0, inertia.1, ...
///     for_each_parameter_number(kepler, [&](const std::string& name, const double&, const auto&) {
///       names.push_back(name);
///     });
///
/// Requires a system that declares its parameters (core/parameter.hpp); of another nothing is visited. Visited are the
/// members of this very system, with the declaration that each belongs to. Nothing throws but what `visit` does.

#include <lagroid/core/parameter.hpp>

#include <string>
#include <type_traits>

namespace lagroid {

/// visit(name, number, declaration) of each.
template <class Sys, class Visit> void for_each_parameter_number(Sys& system, const Visit& visit) {
  for_each_parameter<std::remove_const_t<Sys>>([&]<class Declared>(const Declared& p) {
    if constexpr (requires { p.rule; }) {
      auto& member = system.*p.member;
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, double>) {
        visit(std::string(p.name), member, p);
      } else if constexpr (requires {
                             member.data();
                             member.size();
                           }) {
        for (int i = 0; i < int(member.size()); ++i)
          visit(std::string(p.name) + "." + std::to_string(i), member.data()[i], p);
      }
    }
  });
}

}  // namespace lagroid
