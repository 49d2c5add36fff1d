// What tests of optimal control share.
#pragma once

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/testing/control_laws.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace lagroid::control_tests {

/// What docs/optimal_control_measured.md says of a problem: how far costs are from the reference on grids of 100, 200
/// and 400 stages, and how far they may be on one of N, `constant` / N^2.
inline void record_errors(const std::string& name, const double (&errors)[3], double constant) {
  testing::Test::RecordProperty(
      "errors of " + name, fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", constant, errors[0], errors[1], errors[2]));
}

/// Solves on grids of 100, 200 and 400 stages. Costs are within `margin` C / N^2 of the reference; where the problem is
/// smooth, the two finest extrapolate to it.
template <class Sys>
void expect_second_order(const std::string& name, const ControlTask<Sys>& task, double reference, double constant,
                         bool smooth, int starts = 6) {
  double costs[3];
  int at = 0;
  for (const long stages : {100L, 200L, 400L}) {
    const ControlSearch<Sys> found = search_control(task, stages, {.starts = starts});
    ASSERT_FALSE(found.minima.empty()) << name << " N = " << stages << ": " << found.best_failure.report.message;
    const ControlReport& report = found.minima.front().report;
    costs[at++] = report.cost;
    const double square = double(stages) * double(stages);
    EXPECT_LE(std::abs(report.cost - reference), 5 * constant / square + 1e-6) << name << " N = " << stages;
    EXPECT_LE(report.stationarity, 1e-10) << name;
    EXPECT_LE(report.violation, 1e-10) << name;
    EXPECT_LE(report.complementarity, 1e-9) << name;
    const CrossoverReport& crossover = found.minima.front().crossover;
    EXPECT_TRUE(crossover.crossed()) << name << " N = " << stages << ": " << to_string(crossover.status);
    EXPECT_LE(crossover.after.largest(), 1e-12) << name << " N = " << stages;
    EXPECT_LE(crossover.before.largest(), 1e-9) << name << " N = " << stages;
    EXPECT_TRUE(report.is_strict_minimum()) << name;
  }
  record_errors(name, {costs[0] - reference, costs[1] - reference, costs[2] - reference}, constant);
  if (!smooth) return;
  EXPECT_NEAR((4 * costs[2] - costs[1]) / 3, reference, 2e-6 * std::abs(reference)) << name;
  EXPECT_NEAR(std::log2((costs[0] - reference) / (costs[1] - reference)), 2, 0.1) << name;
}

/// Derivatives at a bent trajectory, and the conditions of optimality at the solution.
template <class Sys> void expect_laws(const ControlTask<Sys>& task, long stages) {
  TranscriptionOf<Sys> bent(task, control_guess(task, stages, 3));
  const laws::LawReport derivatives = laws::transcription_laws(bent, 2);
  EXPECT_TRUE(derivatives.holds()) << derivatives;
  TranscriptionOf<Sys> transcription(task, straight_trajectory(task, stages));
  InteriorPoint solver(transcription);
  const ControlReport found = solver.solve();
  ASSERT_TRUE(found.converged()) << found.message;
  const laws::LawReport optimal =
      laws::optimality_laws(transcription, solver.costates(), solver.inequality_multipliers());
  EXPECT_TRUE(optimal.holds()) << optimal;
}

}  // namespace lagroid::control_tests
