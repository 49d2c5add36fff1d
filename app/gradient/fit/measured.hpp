#pragma once
/// What was measured of runs, read from CSV and HDF5 files: a file for each run, with times and columns of the run.
///
///     const std::vector<MeasuredRun> runs = read_measured(subject, {"run.csv"}, options, fit);
///
/// Adds to the fit the columns that are used, the names of those that are not, and notes on gaps. Errors: DataError,
/// one line, for files that cannot be read, times that are not those of nodes, numbers too large to be squared and
/// columns of which nothing is measured; GradientRefused for columns that are none of the run, for runs between two
/// ends, and for events of which `begin` knows nothing.

#include "fit.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace lagroid::app {

/// One number: when, which function, and by how much it may be off.
struct MeasuredNumber {
  long node;  ///< -1 where steps vary
  double time;
  int observed;  ///< in GradientSubject::observed
  std::size_t column;
  double value;
  double sigma;
};
/// In the order of time.
using MeasuredRun = std::vector<MeasuredNumber>;

std::vector<MeasuredRun> read_measured(const GradientSubject& subject, const std::vector<std::string>& files,
                                       const FitOptions& options, Fit& fit);

}  // namespace lagroid::app
