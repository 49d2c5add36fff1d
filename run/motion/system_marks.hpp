#pragma once
/// Numbers that identify a system: its declared parameters, and its momenta and constraints on an arrow near a unit.
///
/// A run or a study is resumed only by a system with the same numbers; the latter detect members that are not declared.
///
///     const std::vector<double> marks = marks_of(system, q);

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/parameter.hpp>

#include <type_traits>
#include <vector>

namespace lagroid {

/// The parameters that the system declares; and its momenta and constraints on an arrow near the unit at `q`, which
/// depend on members that it does not declare.
template <DiscreteSystem Sys>
std::vector<double> marks_of(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q) {
  using V = Vector<double, Sys::dimension>;
  std::vector<double> out;
  const auto add = [&](const auto& values) { out.insert(out.end(), values.data(), values.data() + values.size()); };
  for_each_parameter<Sys>([&](const auto& p) {
    const auto& member = system.*p.member;
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (std::is_enum_v<Member>) {
      out.push_back(double(static_cast<int>(member)));
    } else if constexpr (std::is_arithmetic_v<Member>) {
      out.push_back(double(member));
    } else {
      add(member);
    }
  });
  const auto arrow = system.groupoid.extend(system.groupoid.unit(q), V(V::LinSpaced(0.01, 0.02)));
  const GradientsOf<Sys> d = gradients(system, arrow, Sys::Multipliers::Ones());
  add(d.source_gradient);
  add(d.target_gradient);
  add(d.constraint);
  return out;
}

}  // namespace lagroid
