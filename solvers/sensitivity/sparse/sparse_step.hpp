#pragma once
/// A step whose unknowns are many, each coupled to few, linearised where it is solved: LinearStep with the cost of the
/// entries that are there. One matrix holds all of it,
///
///     J = ( E_z  E_x )    with x' = X - J_(X,z) E_z^{-1} E,  E = J_(E,x) dx,  X = J_(X,x) dx,
///         ( X_z  X_x )
///
/// and the equations are solved by elimination of the leading unknowns w, which are coupled in small groups alone, then
/// of the multipliers along the graph of their couplings:
///
///     E_z = ( A  B )        S = F - C A^{-1} B,
///           ( C  F )
///
/// of a chain in time linear in its length, backward as forward.
///
///     SparseStep step(pattern);  // which entries there are, column by column
///     step.values = values;      // in the pattern's order
///     step.factor();
///     const Eigen::MatrixXd back = step.backward(gradients);
///
/// Where A or a pivot of S is singular, E_z may be regular: it is factored as a dense matrix then. `factor` returns
/// whether all numbers are finite and E_z is regular. Nothing throws.
///
/// Source: as of linear_step.hpp; block elimination, Golub and Van Loan, Matrix Computations, 3.2.

#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lagroid {

/// Which entries of J may be other than zero: columns are of z, then of x; rows of E, then of X.
struct StepPattern {
  int equations = 0;
  int leading = 0;  ///< of the unknowns and of the equations, those before the multipliers
  int states = 0;
  std::vector<int> begins{0};  ///< where each column does, and the end of the last
  std::vector<int> rows;       ///< of the entries, in each column from the first row down

  int columns() const { return int(begins.size()) - 1; }
  std::span<const int> column(int j) const {
    const int first = begins[std::size_t(j)];
    return {rows.data() + first, std::size_t(begins[std::size_t(j) + 1] - first)};
  }
};

class SparseStep final : public StepDerivative {
 public:
  explicit SparseStep(std::shared_ptr<const StepPattern> pattern);

  const std::shared_ptr<const StepPattern>& pattern() const { return pattern_; }
  std::vector<double> values;

  /// To be called when the values have been filled in.
  bool factor();
  /// dz of directions dx.
  Eigen::MatrixXd unknowns(const Eigen::MatrixXd& directions) const;
  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override;
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override;

  /// Numbers kept: entries of J and of the factors.
  std::size_t entries() const;

 private:
  /// An entry of the pattern: within A, B or C by places in its group, else in E_z.
  struct Entry {
    int row;
    int column;
    int value;
  };
  /// Leading unknowns that are coupled to each other, and the multipliers that are coupled to them: where what belongs
  /// to them begins. The next group begins where they end.
  struct Group {
    int unknown, inverse, own, right, below, product;
    int columns;  ///< of B
  };
  struct Own {
    int place;
    int value;
  };
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  bool eliminate();
  bool factor_densely();
  void solve(Rows& right) const;
  void solve_transposed(Rows& right) const;
  /// The leading rows become A^{-1}, or its transpose, times these.
  void divide(Rows& x, bool transposed) const;
  /// out += sign J x, of the columns from `first` on, as many as x has rows.
  void add_product(int first, double sign, const Rows& x, Rows& out) const;
  /// J^T y of these columns.
  Rows transposed_product(int first, int count, const Rows& y) const;

  std::shared_ptr<const StepPattern> pattern_;
  std::vector<Group> groups_;                 ///< and one behind the last
  std::vector<int> unknowns_;                 ///< group by group
  std::vector<Entry> own_, right_, below_;    ///< of A, B and C, group by group
  std::vector<Entry> couplings_, reactions_;  ///< of B and of C, in E_z
  std::vector<int> products_;                 ///< where in S each row of C with each column of B is, group by group
  std::vector<Own> multipliers_;              ///< of F
  std::vector<double> inverses_;              ///< of A, group by group
  Elimination schur_;
  std::optional<LinearStep> dense_;
};

}  // namespace lagroid
