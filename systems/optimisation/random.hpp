#pragma once
/// Random matrices that are the same on every platform, as no distribution of the standard library promises.

#include <Eigen/Core>

namespace lagroid::optimisation {

/// Entries of mean 0 and variance 1, each a sum of twelve uniform numbers of std::mt19937 (seeded by `seed`), column by
/// column: nearly normal, and unlike std::normal_distribution defined by the standard.
Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed);

/// Its symmetric part, (A + A^T) / 2.
Eigen::MatrixXd random_symmetric(Eigen::Index size, unsigned seed);

}  // namespace lagroid::optimisation
