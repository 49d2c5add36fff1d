#pragma once
/// What a fit says of its solution: what is left over, how well each unknown is known, and what the data do not tell.
///
///     describe_unknowns(runs, subject, unknowns, options, fit);
///     describe_columns(runs, fit);
///
/// Require runs that have been made, with their derivatives, at the solution, and fit.unknowns with their values.
/// Errors: GradientRefused, one line, for a combination that is no expression of unknowns and parameters.

#include "predicted_runs.hpp"

#include <array>
#include <string>
#include <vector>

namespace lagroid::app {

/// An unknown as the scene has it, how large it is taken to be, and between which numbers it stays.
struct Guessed {
  std::string name;  ///< without the run
  double start;
  double size;
  std::array<double, 2> bounds;
};

/// Which unknowns are at a bound, covariance, and what the data do not tell: singular values of J with columns of
/// length one.
void describe_unknowns(const PredictedRuns& runs, const GradientSubject& subject, const std::vector<Guessed>& unknowns,
                       const FitOptions& options, Fit& fit);
/// How each residual goes with the next, of a column of a run after another.
void describe_columns(const PredictedRuns& runs, Fit& fit);

}  // namespace lagroid::app
