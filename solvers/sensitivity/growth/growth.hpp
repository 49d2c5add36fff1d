#pragma once
/// By which factor derivatives grow along a motion, in units of its own, so that kilometres in place of metres change
/// nothing: with diag(d) such that the matrix of a step, d_i^{-1} A_ij d_j, has rows and columns of the same size
/// (Osborne 1960),
///
///     growth = max over columns j of  |d^{-1} max_k |x_j(k)|| / |d^{-1} x_j(0)|.
///
///     Growth growth(directions);                      // x(0), column by column
///     growth.after_a_step(directions);                // x(1), x(2), ...
///     if (growth.wants_matrix()) growth.see(matrix);  // of the step, or of all steps so far
///     const double factor = growth.largest();
///
/// Columns that are zero at the start, those of parameters, count from the first that are not, beyond what each step
/// adds. Required: matrices as large as the directions have rows. Where two components act upon each other one way
/// alone, as momentum upon the place of a free particle, the units are such that all steps together count once.
/// Nothing throws.

#include <Eigen/Core>

#include <vector>

namespace lagroid {

/// The units d of the components of a state.
class OwnUnits {
 public:
  /// Few matrices tell enough: of the first, fourth, sixteenth, ... time it is asked.
  bool wants_matrix() {
    if (++asked_ < next_) return false;
    next_ *= 4;
    return true;
  }
  void see(const Eigen::MatrixXd& matrix);
  /// Ones for so many components where no matrix was seen.
  Eigen::VectorXd of(Eigen::Index components) const;

 private:
  long asked_ = 0;
  long next_ = 1;
  long seen_ = 0;
  Eigen::MatrixXd sum_;  ///< of |A - 1|
};

/// max over columns j of |scale peak_j| / |scale first_j|, from one up; columns that were zero do not count.
double largest_ratio(const Eigen::MatrixXd& first, const Eigen::MatrixXd& peak, const Eigen::VectorXd& scale);

class Growth {
 public:
  explicit Growth(const Eigen::MatrixXd& directions);
  /// Of the first rows of these, and of some of their columns.
  Growth(const Eigen::MatrixXd& directions, Eigen::Index rows, std::vector<Eigen::Index> columns);

  void after_a_step(const Eigen::MatrixXd& directions);
  bool wants_matrix() { return units_.wants_matrix(); }
  void see(const Eigen::MatrixXd& matrix) { units_.see(matrix); }
  double largest() const;

 private:
  OwnUnits units_;
  std::vector<Eigen::Index> columns_;
  Eigen::MatrixXd first_;
  Eigen::MatrixXd peak_;
  Eigen::Array<bool, 1, Eigen::Dynamic> added_;  ///< columns that were zero at the start
  Eigen::RowVectorXd last_;                      ///< the largest entry of each column, after the last step
  long steps_ = 0;
};

}  // namespace lagroid
