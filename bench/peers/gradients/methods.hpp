#pragma once
/// What is compared: the derivatives of Kepler's end (q, p) by its start and its strength, and those of q_x alone.
///
///     const Matrix by_all = adolc_matrix({{1, 0, 0, 1.2, 1}}, 1000, 0.01);
///
/// Requires a start away from the centre. A run that fails throws std::runtime_error.

#include <Eigen/Core>

#include <array>

namespace peers {

/// (q, p, k).
struct Start {
  std::array<double, 5> x;
};
using Matrix = Eigen::Matrix<double, 4, 5>;
using Row = Eigen::Matrix<double, 1, 5>;

Matrix adolc_matrix(const Start& start, long steps, double h);
Row adolc_gradient(const Start& start, long steps, double h);

}  // namespace peers
