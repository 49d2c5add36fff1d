#pragma once
/// Numbers from HDF5 files.
///
///     const Eigen::MatrixXd x = read_hdf5("trajectories.h5", "/x");
///
/// Returns the data set as a matrix, with whatever numbers that are not finite stand in it. Errors: DataError, one line
/// with the remedy.

#include <Eigen/Core>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lagroid::app {

/// A file without the data that it should hold. The message is one line: which file, where in it, what to do.
class DataError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A data set of an HDF5 file, of one or two dimensions, with what may stand there that is not finite. Throws
/// DataError.
Eigen::MatrixXd read_hdf5(const std::filesystem::path& file, const std::string& dataset);

}  // namespace lagroid::app
