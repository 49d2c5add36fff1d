#pragma once
/// Matrices from files.

#include "../reading/data_set.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <filesystem>
#include <string>
#include <variant>

namespace lagroid::app {

using AnyMatrix = std::variant<Eigen::MatrixXd, Eigen::SparseMatrix<double>>;

/// `name` is that of a CSV file (.csv: numbers, rows by lines), of a data set in an HDF5 file (file.h5:/data/set, of
/// one or two dimensions) or of a MatrixMarket file (.mtx: real, dense or sparse, general or symmetric; read by
/// CHOLMOD), seen from `folder`, or from the working folder where it is not there. Throws DataError, also for entries
/// that are not finite.
AnyMatrix read_matrix(const std::string& name, const std::filesystem::path& folder);

Eigen::MatrixXd dense(const AnyMatrix& matrix);
Eigen::Index rows(const AnyMatrix& matrix);
Eigen::Index columns(const AnyMatrix& matrix);

/// The largest |A - A^T| over the largest |A|; infinite where A is not square.
double asymmetry(const AnyMatrix& matrix);

}  // namespace lagroid::app
