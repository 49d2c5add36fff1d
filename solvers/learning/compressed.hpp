#pragma once
/// Least squares with many residuals and few parameters: (J, r) turned by an orthogonal matrix into a triangle,
///
///     Q^T (J r) = (R s),    R^T R = J^T J,    R^T s = J^T r,    |s| = |r|.
///
/// Rows are added in blocks, so that J is never in memory as a whole, nor its condition number squared.
///
///     learning::Compressed compressed(2);  // of two parameters
///     compressed.add(Eigen::MatrixXd::Random(1000, 3));  // rows of (J r)
///     const Eigen::MatrixXd& triangle = compressed.triangle();

#include <Eigen/Core>

namespace lagroid::learning {

/// Residuals r with derivatives J, turned by an orthogonal matrix: Q^T (J r) = (R s), R upper triangular, of one row
/// more than there are parameters. |s| = |r|, R^T R = J^T J and R^T s = J^T r, so that a method of least squares goes
/// the same way with (R, s) as with (J, r), without J^T J, which would square the condition number, and without room
/// for all of J: rows are added in blocks.
class Compressed {
 public:
  explicit Compressed(Eigen::Index parameters);

  /// Forgets all rows.
  void clear();
  /// Adds the rows (J r), parameters + 1 columns.
  void add(const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// Of all rows added: (R s), square.
  const Eigen::MatrixXd& triangle();

 private:
  void fold();

  Eigen::MatrixXd stack_;  ///< the triangle so far, and rows below that are not yet in it
  Eigen::MatrixXd triangle_;
  Eigen::Index used_ = 0;
};

}  // namespace lagroid::learning
