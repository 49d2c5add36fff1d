#pragma once
/// The laws of a system that another one is reduced to, at states below those of the full one.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     for (const laws::LawReport& suite : laws::reduced_certificate<Kepler>(Kepler{}, "rotations", draw))
///       std::cout << suite;
///
/// Those of its groupoid are not among them. Requires states as `certificate` does, at which the symmetry acts freely
/// (throws NotFree elsewhere), and the name of a reduction that the system declares; of another there are no laws. At a
/// fixed momentum they are those of the system in which it is fixed, where that is a reduced one, and of its level.

#include <lagroid/core/reduction/reconstruction.hpp>
#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/solvers/testing/level_laws.hpp>

#include <functional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::laws {

namespace detail {

template <DiscreteSystem Sys, class Phi>
void append_reduced(const Reduction<Phi>& declared, const Sys& system,
                    const std::function<State<typename Sys::GroupoidType>()>& draw, std::vector<LawReport>& reports) {
  const ReducedSystem reduced(system, declared.along);
  for (LawReport& each : system_laws(reduced, [&] { return reduced.state_below(draw()); }))
    reports.push_back(std::move(each));
}
template <DiscreteSystem Sys, class Connection, class First>
void append_reduced(const FixedMomentum<Connection, First>& declared, const Sys& system,
                    const std::function<State<typename Sys::GroupoidType>()>& draw, std::vector<LawReport>& reports) {
  const auto append_level = [&]<class Full>(const Full& full, const auto& draw_full) {
    using Level = MomentumLevel<Connection, Full>;
    const Level any(declared.connection, full, Vector<double, Level::angles>::Zero());
    reports.push_back(level_laws(any, draw_full));
  };
  if constexpr (std::is_same_v<First, Unreduced>) {
    append_level(system, draw);
  } else {
    append_reduced(declared.first, system, draw, reports);
    const ReducedSystem reduced(system, declared.first.along);
    append_level(reduced, [&] { return reduced.state_below(draw()); });
  }
}

}  // namespace detail

template <DiscreteSystem Sys>
std::vector<LawReport> reduced_certificate(const Sys& system, std::string_view name,
                                           const std::function<State<typename Sys::GroupoidType>()>& draw) {
  std::vector<LawReport> reports;
  for_each_reduction<Sys>([&](const auto& declared) {
    if (declared.name == name) detail::append_reduced(declared, system, draw, reports);
  });
  for (LawReport& each : reports) each.subject = "reduced: " + each.subject;
  return reports;
}

}  // namespace lagroid::laws
