#pragma once
/// [parameters] of a scene, as a system declares them (core/parameter.hpp): read, checked and listed.
///
///     const Dido system = read_parameters<Dido>(scene);
///
/// Returns the system that its constructor makes, with the numbers of the scene. Errors: SceneError for a key that is
/// missing, a number that its rule refuses, or a combination that the system refuses.

#include "key.hpp"

#include <lagroid/core/parameter.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lagroid::app {

namespace reading {

void read_number(const Section& parameters, std::string_view name, const NumberRule& rule, bool required,
                 double& value);
/// Into as many numbers as there are.
void read_vector(const Section& parameters, std::string_view name, std::string_view meaning, const NumberRule& rule,
                 bool required, bool direction, double* values, std::size_t size);
std::size_t read_word(const Section& parameters, std::string_view name, std::span<const std::string_view> words,
                      std::size_t fallback);

template <class Sys, class Owner, class Member>
void read(const Section& parameters, const Parameter<Owner, Member>& p, Sys& system) {
  if constexpr (std::is_arithmetic_v<Member>) {
    double value = double(system.*p.member);
    read_number(parameters, p.name, p.rule, p.required, value);
    system.*p.member = Member(value);
  } else {
    auto& vector = system.*p.member;
    read_vector(parameters, p.name, p.meaning, p.rule, p.required, p.direction, vector.data(),
                std::size_t(vector.size()));
  }
}
template <class Sys, class Owner, class Enum, std::size_t N>
void read(const Section& parameters, const Choice<Owner, Enum, N>& p, Sys& system) {
  system.*p.member = Enum(read_word(parameters, p.name, p.words, std::size_t(system.*p.member)));
}

template <class Sys, class Owner, class Member> Key key_of(const Parameter<Owner, Member>& p, const Sys& system) {
  const auto of = [&]<class V>(const V& value, typename V::Read fallback) -> Key {
    KeyOf<V> key{std::string(p.name), value, std::string(p.unit), std::string(p.meaning)};
    if (!p.required) key.fallback = std::move(fallback);
    return key;
  };
  if constexpr (std::is_arithmetic_v<Member>) {
    return of(Number{p.rule}, double(system.*p.member));
  } else {
    const auto& vector = system.*p.member;
    return of(NumberArray{std::size_t(vector.size()), p.rule}, {vector.data(), vector.data() + vector.size()});
  }
}
template <class Sys, class Owner, class Enum, std::size_t N>
Key key_of(const Choice<Owner, Enum, N>& p, const Sys& system) {
  return KeyOf<OneOf>{std::string(p.name),
                      {{p.words.begin(), p.words.end()}},
                      "",
                      std::string(p.meaning),
                      std::string(p.words[std::size_t(system.*p.member)])};
}

/// Blames the first of its parameters that stands there.
[[noreturn]] void blame(const Section& parameters, const Refusal& refusal);

}  // namespace reading

/// The system with the parameters of a scene.
template <class Sys> Sys read_parameters(const Section& scene) {
  std::string needed;
  for_each_parameter<Sys>([&](const auto& p) {
    if constexpr (requires { p.required; })
      if (p.required) needed += fmt::format("{}{}", needed.empty() ? "" : ", ", p.name);
  });
  const Section parameters =
      needed.empty() ? scene.section_or_empty("parameters") : scene.section("parameters", needed);
  Sys system;
  for_each_parameter<Sys>([&](const auto& p) { reading::read(parameters, p, system); });
  if (const auto refusal = refusal_of(system)) reading::blame(parameters, *refusal);
  return system;
}

/// The same as keys; `system` is as its constructor makes it.
template <class Sys> std::vector<Key> parameter_keys(const Sys& system = {}) {
  std::vector<Key> all;
  for_each_parameter<Sys>([&](const auto& p) { all.push_back(reading::key_of(p, system)); });
  return all;
}

}  // namespace lagroid::app
