#pragma once
/// Numbers from HDF5 files.
///
///     const Eigen::MatrixXd x = read_hdf5("trajectories.h5", "/x");
///
/// Returns the data set as a matrix, with whatever numbers that are not finite stand in it. Errors: DataError, one line
/// with the remedy.

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

/// A file without the data that it should hold. The message is one line: which file, where in it, what to do.
class DataError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A data set of an HDF5 file, of one or two dimensions, with what may stand there that is not finite. Throws
/// DataError.
Eigen::MatrixXd read_hdf5(const std::filesystem::path& file, const std::string& dataset);

/// Whether it is an HDF5 file, whatever its name.
bool is_hdf5(const std::filesystem::path& file);

/// Columns that belong together: row after row, from the row `first` of time on.
struct RecordedSeries {
  std::vector<std::string> columns;
  std::vector<double> values;
  std::size_t first;

  /// NaN before the first row.
  double at(std::size_t row, std::size_t column) const;
};

/// The series of a file as trajectory.h5 of a run: a data set `time` (or `t`), and others of as many rows, each of
/// which `use(times, series)` gets in turn. Columns have the names that the run gave them; where the file is none of a
/// run, that of the data set, or x.0, x.1, ... of a data set x with several. Throws DataError.
void read_series(const std::filesystem::path& file,
                 const std::function<void(const std::vector<double>&, const RecordedSeries&)>& use);

}  // namespace lagroid::app
