#pragma once
/// The numbers among the parameters of a system, by their names: read, and given other values.
///
///     Kepler kepler;
///     const std::vector<ParameterValue> to{{"strength", 0.5}};
///     if (const std::string why = set_parameters(kepler, to); !why.empty()) std::cerr << why << '\n';
///
/// Names are those of `parameters()`, numbers of a vector by their places (inertia.0); directions, which keep their
/// length, are left out. Returns why the first value that is refused is; the others are set. Nothing throws.

#include <lagroid/core/parameter.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace lagroid {

/// visit(name, number, rule) of each.
template <class Sys, class Visit> void for_each_parameter_number(Sys& system, const Visit& visit) {
  for_each_parameter<std::remove_const_t<Sys>>([&]<class Declared>(const Declared& p) {
    if constexpr (requires { p.rule; }) {
      auto& member = system.*p.member;
      if (p.direction) return;
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, double>) {
        visit(std::string(p.name), member, p.rule);
      } else if constexpr (requires {
                             member.data();
                             member.size();
                           }) {
        for (int i = 0; i < int(member.size()); ++i)
          visit(std::string(p.name) + "." + std::to_string(i), member.data()[i], p.rule);
      }
    }
  });
}

template <class Sys> std::vector<ParameterValue> parameter_values(const Sys& system) {
  std::vector<ParameterValue> all;
  for_each_parameter_number(system, [&](const std::string& name, double value, const NumberRule&) {
    all.push_back({name, value});
  });
  return all;
}

template <class Sys> std::string set_parameters(Sys& system, std::span<const ParameterValue> to) {
  std::string refused;
  for_each_parameter_number(system, [&](const std::string& name, double& number, const NumberRule& rule) {
    for (const ParameterValue& each : to) {
      if (each.name != name) continue;
      number = each.value;
      if (refused.empty() && !(std::isfinite(number) && rule.holds(number)))
        refused = fmt::format("{} becomes {:g}, and is to be {}", name, number, rule.words);
    }
  });
  if (refused.empty())
    if (const auto why = refusal_of(system)) refused = why->why;
  return refused;
}

}  // namespace lagroid
