#pragma once
/// What errors of the start and of the parameters become along a run: with normal errors of covariance C, in the linear
/// approximation,
///
///     Sigma = J C J^T,    J the exact derivatives;
///
/// and what they become without it, of runs from starts that are drawn. C is diagonal, of independent errors, or what a
/// fit found (fit.hpp).
///
///     const InputErrors errors = independent_errors(subject, {"initial.momentum=0.01"});
///     const Uncertainty end = uncertainty_of(subject, {"final"}, errors, {});
///
/// Errors: GradientRefused, one line, for what has no derivative, no such name or no deviation, and for what was fitted
/// of another system; DataError for a file that no fit has written, with no covariance, or whose data did not tell an
/// unknown.

#include "gradient_table.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

/// Of starts and parameters, each by a name of its own: initial.NAME or parameters.NAME, starts first.
struct InputErrors {
  std::vector<std::string> names;
  Eigen::MatrixXd covariance;
  bool are_independent = true;
  std::vector<double> values = {};      ///< what was fitted, in place of what the scene has
  std::string system = {};              ///< of which it was
  std::vector<std::string> notes = {};  ///< on numbers of a group that have none
};
/// Of words NAME=SIGMA, where NAME may be a group: each number of it has that deviation.
InputErrors independent_errors(const GradientSubject& subject, const std::vector<std::string>& words);
/// Of what `lagroid fit --json` printed into a file.
InputErrors fitted_errors(const std::string& file);
/// The subject from where these errors are about.
GradientSubject moved_to(const GradientSubject& subject, const InputErrors& errors);

/// How many runs are drawn, and from which stream of numbers.
struct Draws {
  long count = 0;
  std::uint64_t seed = 1;
};

struct Uncertainty {
  GradientTable table;
  InputErrors errors;          ///< of its columns
  Eigen::MatrixXd covariance;  ///< of its rows
  /// The same of runs that were drawn.
  struct Sample {
    long runs = 0;
    long failed = 0;     ///< of these, which failed, or ended elsewhere, and do not count
    long refused = 0;    ///< of these, whose numbers no scene may have, as a negative length, and which do not count
    long otherwise = 0;  ///< of those that count, through other events than the run in the middle
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  std::optional<Sample> sample;
};

Uncertainty uncertainty_of(const GradientSubject& subject, const std::vector<std::string>& of,
                           const InputErrors& errors, const Draws& draws);

std::string text_of(const Uncertainty& uncertainty);
std::string json_of(const Uncertainty& uncertainty);

}  // namespace lagroid::app
