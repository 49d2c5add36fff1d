#pragma once
/// The laws of a Poisson bracket as a test suite that any Poisson system runs by naming itself: antisymmetry, the
/// Jacobi identity, Casimirs.
///
/// A bivector with a wrong sign still moves points; only the Jacobi identity tells.
///
///     const auto draw = [] { return Vector<double, 2>(1 + draw_uniform() / 2, 1 + draw_uniform() / 2); };
///     const LawReport report = poisson_laws("populations", Populations{}, draw);
///     EXPECT_TRUE(report.holds());
///
/// Requires RapidCheck, and points from `draw` where the bracket is smooth. Returns a LawReport; where a law is broken,
/// its first failure names the worst point, the entries and the value. Errors: what the system throws is in the report.

#include <lagroid/core/poisson/bracket_defects.hpp>
#include <lagroid/core/testing/property.hpp>

#include <string>

namespace lagroid::laws {

template <PoissonStructure Sys, class Draw>
LawReport poisson_laws(const std::string& subject, const Sys& system, const Draw& draw, double tolerance = 1e-13) {
  LawReport report{subject, {}};
  const auto law = [&](const std::string& name, const auto& defect) {
    BracketDefect worst;
    Law found = check_law(name, tolerance, [&] {
      const BracketDefect here = defect(Vector<double, Sys::dimension>(draw()));
      worst.raise(here);
      return here.relative;
    });
    if (worst.relative > tolerance) found.first_failure = worst.sentence();
    report.laws.push_back(found);
  };
  law("the bivector is antisymmetric", [&](const auto& x) { return antisymmetry_defect(system, x); });
  law("Jacobi identity of the bracket", [&](const auto& x) { return jacobi_defect(system, x); });
  if constexpr (casimir_count<Sys>() > 0)
    law("Casimirs commute with all functions", [&](const auto& x) { return casimir_defect(system, x); });
  return report;
}

}  // namespace lagroid::laws
