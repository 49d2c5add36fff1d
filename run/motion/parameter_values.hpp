#pragma once
/// The numbers among the parameters of a system, by their names: read, and given other values.
///
///     Kepler kepler;
///     const std::vector<ParameterValue> to{{"strength", 0.5}};
///     if (const std::string why = set_parameters(kepler, to); !why.empty()) std::cerr << why << '\n';
///
/// Names are those of `parameters()`, numbers of a vector by their places (inertia.0); directions, which keep their
/// length, are left out. Returns why the first value that is refused is; the others are set. Nothing throws.

#include <lagroid/core/capabilities/parameter_numbers.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace lagroid {

template <class Sys> std::vector<ParameterValue> parameter_values(const Sys& system) {
  std::vector<ParameterValue> all;
  for_each_parameter_number(system, [&](const std::string& name, double value, const auto& declared) {
    if (!declared.direction) all.push_back({name, value});
  });
  return all;
}

template <class Sys> std::string set_parameters(Sys& system, std::span<const ParameterValue> to) {
  std::string refused;
  for_each_parameter_number(system, [&](const std::string& name, double& number, const auto& declared) {
    if (declared.direction) return;
    for (const ParameterValue& each : to) {
      if (each.name != name) continue;
      number = each.value;
      if (refused.empty() && !(std::isfinite(number) && declared.rule.holds(number)))
        refused = fmt::format("{} becomes {:g}, and is to be {}", name, number, declared.rule.words);
    }
  });
  if (refused.empty())
    if (const auto why = refusal_of(system)) refused = why->why;
  return refused;
}

}  // namespace lagroid
