#pragma once
/// Every law there is, asked of one system.

#include <lagroid/core/testing/algebroid_laws.hpp>
#include <lagroid/core/testing/cotangent_laws.hpp>
#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/solvers/testing/dalembert_laws.hpp>
#include <lagroid/solvers/testing/dynamics_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/solvers/testing/variational_laws.hpp>

#include <functional>
#include <vector>

namespace lagroid::laws {

/// The suites that apply to a system: of its groupoid, algebroid and cotangent groupoid, at objects of the states
/// drawn; of its derivatives, its dynamics, its momenta, its declared symmetries and its action principle, at steps
/// from those states. Of a forced or nonholonomic system, whose step is not Poisson, the Lagrange-d'Alembert principle
/// is asked in place of dynamics and action. `draw()` returns a State from which a step can be taken.
template <DiscreteSystem Sys>
std::vector<LawReport> certificate(const Sys& system, const std::function<State<typename Sys::GroupoidType>()>& draw) {
  const auto& groupoid = system.groupoid;
  const auto object = [&] { return draw().object; };
  std::vector<LawReport> reports{
      groupoid_laws(groupoid, object),
      algebroid_laws(groupoid, object),
      cotangent_laws(groupoid, object),
      derivative_laws(system, [&] { return step_from(system, draw()); }),
  };
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

}  // namespace lagroid::laws
