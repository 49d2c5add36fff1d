#pragma once
/// What errors of the start and of the parameters become along a run: with independent normal errors of deviations
/// sigma_j, in the linear approximation,
///
///     Sigma = J diag(sigma^2) J^T,    J the exact derivatives;
///
/// and what they become without it, of runs from starts that are drawn.
///
///     const Uncertainty end = uncertainty_of(subject, {"final"}, deviations_of({"initial.momentum=0.01"}), {});
///
/// Errors: GradientRefused, one line, for what has no derivative, no such name or no deviation.

#include "gradient_table.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

/// A start or a parameter, and the standard deviation of its error.
struct Deviation {
  std::string name;  ///< initial.NAME or parameters.NAME
  double size;
};
/// Of words NAME=NUMBER.
std::vector<Deviation> deviations_of(const std::vector<std::string>& words);

/// How many runs are drawn, and from which stream of numbers.
struct Draws {
  long count = 0;
  std::uint64_t seed = 1;
};

struct Uncertainty {
  GradientTable table;
  Eigen::VectorXd deviations;  ///< of its columns
  Eigen::MatrixXd covariance;  ///< of its rows
  /// The same of runs that were drawn.
  struct Sample {
    long runs = 0;
    long failed = 0;  ///< of these, which ended early and do not count
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  std::optional<Sample> sample;
};

Uncertainty uncertainty_of(const GradientSubject& subject, const std::vector<std::string>& of,
                           const std::vector<Deviation>& deviations, const Draws& draws);

std::string text_of(const Uncertainty& uncertainty);
std::string json_of(const Uncertainty& uncertainty);

}  // namespace lagroid::app
