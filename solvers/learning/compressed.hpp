#pragma once
/// Least squares with many residuals and few parameters.

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
