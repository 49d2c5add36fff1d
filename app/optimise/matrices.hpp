#pragma once
/// Matrices from files.

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>

namespace lagroid::app {

/// A file without the matrix that it should hold. The message is one line: which file, where in it, what to do.
class DataError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

using AnyMatrix = std::variant<Eigen::MatrixXd, Eigen::SparseMatrix<double>>;

/// `name` is that of a CSV file (.csv: numbers, rows by lines), of a data set in an HDF5 file (file.h5:/data/set, of
/// one or two dimensions) or of a MatrixMarket file (.mtx: real, dense or sparse, general or symmetric; read by
/// CHOLMOD), seen from `folder`, or from the working folder where it is not there. Throws DataError, also for entries
/// that are not finite.
AnyMatrix read_matrix(const std::string& name, const std::filesystem::path& folder);

/// A data set of an HDF5 file, of one or two dimensions, with what may stand there that is not finite. Throws
/// DataError.
Eigen::MatrixXd read_hdf5(const std::filesystem::path& file, const std::string& dataset);

Eigen::MatrixXd dense(const AnyMatrix& matrix);
Eigen::Index rows(const AnyMatrix& matrix);
Eigen::Index columns(const AnyMatrix& matrix);

/// The largest |A - A^T| over the largest |A|; infinite where A is not square.
double asymmetry(const AnyMatrix& matrix);

}  // namespace lagroid::app
