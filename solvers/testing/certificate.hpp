#pragma once
/// The certificate of a system: every suite of laws that applies to it, from the axioms of its groupoid to Noether's
/// theorem. One call tests a system of your own by all that the theory states of it.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     for (const laws::LawReport& suite : laws::certificate<Kepler>(Kepler{}, draw)) std::cout << suite;
///
/// Requires states from which a step can be taken. Returns one report a suite, each with its laws, samples and the
/// largest defect; a law that does not hold is no exception. The suites' headers name equations and sources.

#include <lagroid/core/testing/algebroid_laws.hpp>
#include <lagroid/core/testing/cotangent_laws.hpp>
#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/solvers/testing/dalembert_laws.hpp>
#include <lagroid/solvers/testing/dynamics_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/solvers/testing/variational_laws.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace lagroid::laws {

/// The suites of a system's groupoid, of its algebroid and of its cotangent groupoid, at objects of the states drawn.
/// No step is taken: what is no groupoid may have none.
template <DiscreteSystem Sys>
std::vector<LawReport> groupoid_certificate(const Sys& system,
                                            const std::function<State<typename Sys::GroupoidType>()>& draw) {
  const auto& groupoid = system.groupoid;
  const auto object = [&] { return draw().object; };
  return {groupoid_laws(groupoid, object), algebroid_laws(groupoid, object), cotangent_laws(groupoid, object)};
}

/// The suites of a system itself, on a groupoid whose laws are tested elsewhere: of its derivatives, its dynamics, its
/// momenta, its declared symmetries and its action principle, at steps from the states drawn. Of a forced or
/// nonholonomic system, whose step is not Poisson, the Lagrange-d'Alembert principle is tested in place of dynamics and
/// action. `draw()` returns a State from which a step can be taken.
template <DiscreteSystem Sys>
std::vector<LawReport> system_laws(const Sys& system, const std::function<State<typename Sys::GroupoidType>()>& draw) {
  std::vector<LawReport> reports{derivative_laws(system, [&] { return step_from(system, draw()); })};
  const auto append = [&](LawReport report) {
    if (!report.laws.empty()) reports.push_back(std::move(report));
  };
  if constexpr (Variational<Sys>) {
    reports.push_back(dynamics_laws(system, draw));
    // Paths between fixed ends, whose arrows a time-dependent system would take at one time.
    if constexpr (!TimeDependent<Sys>) reports.push_back(variational_laws(system, draw));
  } else {
    reports.push_back(dalembert_laws(system, draw));
  }
  append(momentum_laws(system, draw));
  if constexpr (requires { system.symmetries(); }) append(noether_laws(system, system.symmetries(), draw));
  return reports;
}

/// All of them: of its groupoid, algebroid and cotangent groupoid, at objects of the states drawn, then its own.
template <DiscreteSystem Sys>
std::vector<LawReport> certificate(const Sys& system, const std::function<State<typename Sys::GroupoidType>()>& draw) {
  std::vector<LawReport> reports = groupoid_certificate(system, draw);
  for (LawReport& report : system_laws(system, draw)) reports.push_back(std::move(report));
  return reports;
}

}  // namespace lagroid::laws
