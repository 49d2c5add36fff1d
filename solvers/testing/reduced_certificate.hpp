#pragma once
/// The laws of a system that another one is reduced to, at states below those of the full one.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     for (const laws::LawReport& suite : laws::reduced_certificate<Kepler>(Kepler{}, "rotations", draw))
///       std::cout << suite;
///
/// Those of its groupoid are not among them. Requires states as `certificate` does, at which the symmetry acts freely
/// (throws NotFree elsewhere), and the name of a reduction that the system declares; of another there are no laws. At a
/// fixed momentum they are those of the system in which it is fixed.

#include <lagroid/core/reduction/reconstruction.hpp>
#include <lagroid/solvers/testing/certificate.hpp>

#include <functional>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lagroid::laws {

namespace detail {

template <class Phi> const Reduction<Phi>& morphism_of(const Reduction<Phi>& declared) { return declared; }
template <class Connection, class First> const First& morphism_of(const FixedMomentum<Connection, First>& declared) {
  return declared.first;
}

}  // namespace detail

template <DiscreteSystem Sys>
std::vector<LawReport> reduced_certificate(const Sys& system, std::string_view name,
                                           const std::function<State<typename Sys::GroupoidType>()>& draw) {
  std::vector<LawReport> reports;
  for_each_reduction<Sys>([&](const auto& declared) {
    const auto& by = detail::morphism_of(declared);
    if constexpr (!std::is_same_v<decltype(by), const Unreduced&>) {
      if (declared.name != name) return;
      const ReducedSystem reduced(system, by.along);
      reports = system_laws(reduced, [&] { return reduced.state_below(draw()); });
      for (LawReport& each : reports) each.subject = "reduced: " + each.subject;
    }
  });
  return reports;
}

}  // namespace lagroid::laws
