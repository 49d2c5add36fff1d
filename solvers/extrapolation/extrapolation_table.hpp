#pragma once
/// The arithmetic of extrapolation in h^2, whatever it is that is extrapolated: from values R_j that a symmetric method
/// reaches over a time H in n_j equal steps, n_j = j or 2 j, j = 1, ..., k, one of order 2 k,
///
///     T_k = sum_j w_j R_j,    w_j = prod_{i != j} n_j^2 / (n_j^2 - n_i^2),
///
/// the value at h = 0 of the polynomial in h^2 through them.
///
///     ExtrapolationOrder order(1e-10, 4, 2);  // tolerance, lanes of a register, n_j / j
///     const auto& rows = order.table();    // as many as it takes now
///     const auto verdict = order.judge(h, error, error_below, size);  // accepted? the next step's size
///
/// The order and the size of steps are those that cost least for a unit of time (Deuflhard, Numer. Math. 41 (1983);
/// Hairer, Norsett, Wanner, Solving ODEs I, II.9). Throws std::invalid_argument for a tolerance, lanes
/// or a unit that are not positive.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/types.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace lagroid {

/// Tried on the way from one node to the next.
inline constexpr long most_inner_steps = 1'000'000;

/// k rows of n_j = unit j steps, and how they share the lanes of a register: rows do not depend on each other.
struct ExtrapolationTable {
  static constexpr int fewest_rows = 2;
  static constexpr int most_rows = 8;

  /// A row j that has come to its end.
  struct End {
    int lane;
    int row;
  };
  /// A step of every lane, in units of H. Flags are 1 or 0.
  struct Slot {
    std::vector<double> time;    ///< where it begins
    std::vector<double> step;    ///< 1 / n_j; 0 in lanes that have no more rows
    std::vector<double> first;   ///< whether it is the first of its row
    std::vector<double> last;    ///< whether it is the last of its row
    std::vector<double> others;  ///< whether another row begins after it; empty where none does in any lane
    std::vector<End> ends;       ///< after it
    bool begins = false;         ///< whether it is the first of a row in some lane
  };

  int rows = 0;             ///< k
  std::vector<Slot> slots;  ///< as many as the lane with most takes: what the table costs
  /// By which rows, a line each, give T_k, its difference from the value without the first row, of order 2 k - 2, and
  /// the same of the table with one row less.
  Eigen::Matrix<double, Eigen::Dynamic, 3> weights;
  double growth = 0;  ///< sum_j |w_j|, by which rounding of rows grows

  double cost() const { return double(slots.size()); }

  /// Rows are dealt out longest first, each to the lane that has least. Throws std::invalid_argument for more rows than
  /// there are.
  static ExtrapolationTable of(int rows, int lanes, int unit);
};

/// Which order comes next, and which step.
class ExtrapolationOrder {
 public:
  /// No step is longer than `longest`, so that orders which could go further do not pay.
  ExtrapolationOrder(double tolerance, int lanes, int unit, double longest = std::numeric_limits<double>::infinity());

  const ExtrapolationTable& table() const { return (*tables_)[std::size_t(rows_)]; }
  struct Verdict {
    bool accepted;
    double next;  ///< the size of the next step, or of the next try
  };
  /// Of a step of that size, with the errors that the table estimates, of numbers of a size whose rounding is no error.
  Verdict judge(double h, double error, double error_below, double number);

  /// What the next step goes on from.
  struct Memory {
    int rows = 0;
  };
  Memory memory() const { return {rows_}; }
  void go_back_to(const Memory& at) { rows_ = at.rows; }
  void serialize(NumberArchive& archive) { archive(rows_); }

 private:
  double tolerance_;
  double longest_;
  int rows_ = 0;
  using Tables = std::array<ExtrapolationTable, ExtrapolationTable::most_rows + 1>;
  static std::shared_ptr<const Tables> tables_of(int lanes, int unit);
  std::shared_ptr<const Tables> tables_;
};

}  // namespace lagroid
