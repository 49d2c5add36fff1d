#pragma once
/// An optimal control problem as a nonlinear program of IPOPT, in the chart of its trajectories: sparse, with exact
/// first and second derivatives. Private to this folder and its tests, for it includes IPOPT's headers.
///
/// Unknowns stand in the order of the trajectory: node 0, then of each stage its control and the node it leads to, then
/// t; what is fixed is left out. Rows are those of phi and gamma, stage by stage; bounds of controls are bounds of
/// unknowns.
///
/// Which entries of a stage's block are ever different from zero is found by trials, as one would write it by hand.
/// Where an entry turns out to be left out wrongly, the evaluation fails and `missed_an_entry` says so: solve again
/// with whole blocks.

#include <lagroid/solvers/control/ipopt/trajectory_chart.hpp>

#include <IpTNLP.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace lagroid {

class ControlProgram final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  enum class Blocks { sparse, whole };

  /// `keep_going` is asked in every iteration.
  ControlProgram(TrajectoryChart& chart, Blocks blocks, std::function<bool()> keep_going = {});

  bool missed_an_entry() const { return missed_; }
  const StageRows& costates() const { return costates_; }
  const StageRows& inequality_multipliers() const { return multipliers_; }

  bool get_nlp_info(Index& variables, Index& rows, Index& in_jacobian, Index& in_hessian,
                    IndexStyleEnum& style) override;
  bool get_bounds_info(Index, Number* least, Number* most, Index, Number* least_row, Number* most_row) override;
  bool get_starting_point(Index count, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override;
  bool eval_f(Index, const Number* x, bool is_new, Number& cost) override;
  bool eval_grad_f(Index count, const Number* x, bool is_new, Number* gradient) override;
  bool eval_g(Index, const Number* x, bool is_new, Index, Number* rows) override;
  bool eval_jac_g(Index, const Number* x, bool is_new, Index, Index, Index* row, Index* column, Number* value) override;
  bool eval_h(Index, const Number* x, bool is_new, Number factor, Index, const Number* multipliers, bool, Index,
              Index* row, Index* column, Number* value) override;
  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number, Number, Number,
                             Number, Index, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    return !keep_going_ || keep_going_();
  }
  /// Lets the chart stand at the solution.
  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number* of_lower, const Number* of_upper,
                         Index, const Number*, const Number* multipliers, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override;

 private:
  Index first_row(long stage) const { return first_row_[std::size_t(stage)]; }
  /// The place of a stage's variable among the unknowns; -1 where it is fixed.
  Index place(long stage, int variable) const;
  const Transcription& transcription() const { return chart_.transcription(); }

  void move_to(const Number* x, bool is_new);
  void evaluate_values();
  void evaluate_derivatives();
  void evaluate_hessians(double factor, const Number* multipliers);
  void take(const Number* multipliers);
  void pull_back(long stage, const double* row, double* out) const;
  void pull_back_rows(long stage);
  void pull_back_hessian(long stage, double of_cost);
  void find_entries();
  void notice_missed(const std::vector<double>& entries, const std::vector<char>& is_in);

  /// visit(row, column, place in `rows_`) of a stage's entries.
  template <class Visit> void for_each_in_rows(long stage, const Visit& visit) const {
    const int equalities = sizes_.equalities_of(stage);
    for (const auto& [row, variable] : in_rows_) {
      const Index column = place(stage, variable);
      if (column < 0 || (row >= equalities && row < sizes_.equality)) continue;
      const int row_here = row < sizes_.equality ? row : row - sizes_.equality + equalities;
      visit(first_row(stage) + row_here, column, row * sizes_.variables() + variable);
    }
  }
  /// visit(row, column, place in `block_`); which of the two comes first is the unknowns' order.
  template <class Visit> void for_each_in_hessian(long stage, const Visit& visit) const {
    for (const auto& [row, column] : in_hessian_) {
      const Index i = place(stage, row);
      const Index j = place(stage, column);
      if (i >= 0 && j >= 0) visit(i, j, row * sizes_.variables() + column);
    }
  }

  TrajectoryChart& chart_;
  std::function<bool()> keep_going_;
  TranscriptionSizes sizes_;
  int before_bounds_ = 0;
  std::vector<Index> node_place_;  // of each component of each node
  std::vector<Index> control_place_;
  std::vector<Index> duration_place_;  // of each phase
  std::vector<Index> first_row_;       // of each stage, and the count of all
  std::vector<int> bound_row_;         // among a stage's multipliers: of each control's upper bound and lower one
  Index unknowns_ = 0;

  // Of a stage: (row, variable), the rows of gamma after all of phi; (variable, variable) of the lower triangle.
  std::vector<std::pair<int, int>> in_rows_;
  std::vector<std::pair<int, int>> in_hessian_;
  std::vector<char> is_in_rows_;
  std::vector<char> is_in_hessian_;
  bool missed_ = false;

  TrajectoryDisplacement at_;
  bool stands_ = false;
  bool has_values_ = false;
  bool has_derivatives_ = false;
  StageValues values_;
  StageDerivatives derivatives_;
  StageRows first_;   // D of each node
  StageRows second_;  // Q
  StageRows costates_;
  StageRows multipliers_;
  StageRows without_;  // the Hessians of costs alone
  // Of one stage, by x.
  std::vector<double> rows_;
  std::vector<double> block_;
  std::vector<double> half_;  // a block by x on one side
};

}  // namespace lagroid
