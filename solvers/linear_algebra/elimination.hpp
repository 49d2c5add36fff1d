#pragma once
/// Gaussian elimination of one sparse pattern, many times: A x = b with a pattern known beforehand. The multipliers of
/// a chain of joints have such a matrix in every iteration of every step, and its order and fill are found once.
///
///     Elimination elimination(2, {{0, 1}});
///     elimination.value(elimination.index(0, 0)) = elimination.value(elimination.index(1, 1)) = 1;
///     double x[] = {1, 2};
///     if (elimination.factorise()) elimination.solve(x);  // b on entry, x on return
///
/// Requires a structurally symmetric pattern and leading pivots that do not vanish; `clear` before the values are
/// written anew, for a factorisation takes their place. `factorise` returns false for a singular matrix.

#include <utility>
#include <vector>

namespace lagroid {

/// The factorisation of matrices with one structurally symmetric pattern whose leading pivots do not vanish: those of
/// D A^{-1} D'^T with A positive definite and D' near D, the multipliers' matrices of mechanical joints. The order of
/// elimination (minimum degree) and the fill are found once; where the pattern is that of a chain or a tree
/// nothing is filled in, and a factorisation costs O(n).
class Elimination {
 public:
  Elimination() = default;
  /// `pairs`: the entries (i, j), i != j, that may be non-zero; (j, i) is understood. The diagonal is always there.
  Elimination(int size, const std::vector<std::pair<int, int>>& pairs);

  int size() const { return int(order_.size()); }
  /// Numbers kept, fill included.
  std::size_t entries() const { return values_.size(); }
  /// Where the entry (i, j) of the pattern is stored.
  int index(int i, int j) const;

  void clear();
  double& value(int index) { return values_[std::size_t(index)]; }

  /// Factorises what the values hold. False where a pivot is not a number, or below 1e-13 times the diagonal entry
  /// it began as: the matrix is singular then.
  bool factorise();
  /// The same, for matrices of which some rows depend on others: such rows are left out from now on, their unknowns are
  /// zero in every solution. Returns them.
  std::vector<int> leave_out_dependent();
  /// b <- the solution.
  void solve(double* b) const;
  /// The same of several right sides, for each unknown `sides` numbers one after another.
  void solve(double* b, int sides) const;
  /// Of the transposed equations.
  void solve_transposed(double* b, int sides) const;

 private:
  struct Pivot {
    int unknown;
    int values;  // first of its stored numbers: the diagonal, the column below, the row to the right
    int count;   // how many in that column, and in that row
    int others;  // first of their unknowns
    bool left_out = false;
  };
  template <bool LeaveOut> bool eliminate(double least, std::vector<int>* dependent);

  std::vector<int> order_;  // unknown -> place in the order of elimination
  std::vector<Pivot> pivots_;
  std::vector<double> values_;
  std::vector<int> others_;
  std::vector<int> products_;  // count^2 a pivot: where column times row is taken from
  std::vector<double> first_;  // the diagonal before elimination
};

}  // namespace lagroid
