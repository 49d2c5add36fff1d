#pragma once
/// The arithmetic of extrapolation in h^2, whatever it is that is extrapolated: from values R_j that a symmetric method
/// reaches over a time H in n_j = 2 j equal steps, j = 1, ..., k, one of order 2 k,
///
///     T_k = sum_j w_j R_j,    w_j = prod_{i != j} n_j^2 / (n_j^2 - n_i^2),
///
/// the value at h = 0 of the polynomial in h^2 through them.
///
///     ExtrapolationOrder order(1e-10, 4);  // tolerance, lanes of a register
///     const auto& rows = order.table();    // as many as it takes now
///     const auto verdict = order.judge(h, error, error_below);  // accepted? the next step's size
///
/// The order and the size of steps are those that cost least for a unit of time (Deuflhard, Numer. Math. 41 (1983);
/// Hairer, Norsett, Wanner, Solving ODEs I, II.9). Throws std::invalid_argument for a tolerance or lanes that are not
/// positive.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/types.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace lagroid {

/// Of what a scene may choose: its orders go up to that.
inline constexpr DeclaredMethod extrapolation_method{.name = "extrapolation",
                                                     .order = 16,
                                                     .stages = 8,
                                                     .source = {"deuflhard1983", "orders and steps of extrapolation"}};

/// k rows of 2, 4, ..., 2 k steps, and how they share the lanes of a register: rows do not depend on each other.
struct ExtrapolationTable {
  static constexpr int fewest_rows = 2;
  static constexpr int most_rows = 8;

  /// A row j that has come to its end.
  struct End {
    int lane;
    int row;
  };
  /// A step of every lane, in units of H.
  struct Slot {
    std::vector<double> time;      ///< where each of them begins
    std::vector<double> reach;     ///< h where a row begins, else 2 h; 0 in lanes that have no more rows
    std::vector<End> ends;         ///< after it
    std::vector<double> restarts;  ///< after it, 1 where another row begins, else 0; empty where none does
  };

  int rows = 0;             ///< k
  std::vector<Slot> slots;  ///< as many as the lane with most takes: what the table costs
  /// By which rows, a line each, give T_k, its difference from the value without the first row, of order 2 k - 2, and
  /// the same of the table with one row less.
  Eigen::Matrix<double, Eigen::Dynamic, 3> weights;
  double growth = 0;  ///< sum_j |w_j|, by which rounding of rows grows

  double cost() const { return double(slots.size()); }

  /// Rows are dealt out longest first, each to the lane that has least.
  static ExtrapolationTable of(int rows, int lanes);
};

/// Which order comes next, and which step.
class ExtrapolationOrder {
 public:
  ExtrapolationOrder(double tolerance, int lanes);

  const ExtrapolationTable& table() const { return tables_[std::size_t(rows_)]; }
  struct Verdict {
    bool accepted;
    double next;  ///< the size of the next step, or of the next try
  };
  /// Of a step of that size, with the errors that the table estimates, of which `rounding` is noise.
  Verdict judge(double h, double error, double error_below, double rounding);

  /// What the next step goes on from.
  struct Memory {
    int rows = 0;
  };
  Memory memory() const { return {rows_}; }
  void go_back_to(const Memory& at) { rows_ = at.rows; }
  void serialize(NumberArchive& archive) { archive(rows_); }

 private:
  double tolerance_;
  int rows_ = 0;
  std::array<ExtrapolationTable, ExtrapolationTable::most_rows + 1> tables_;
};

}  // namespace lagroid
