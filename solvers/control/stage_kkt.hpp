#pragma once
/// The KKT matrix of an optimal control problem with its elimination, linear in the number of stages:
///
///     unknowns of stage k:  y_k = (du_k, dlambda_k, v_{k+1}),    beside all stages:  (free ones of v_0, t_1, t_2 ...).
///
/// The matrix is block-tridiagonal but for the few unknowns beside all stages, which border it: these have no place
/// along the trajectory where their pivot would be safe. The duration of a phase has a column from where its phase
/// begins.
///
///     StageKkt kkt(transcription);
///     kkt.assemble(derivatives, sigma);
///     const StageKkt::Inertia inertia = kkt.factor(0, dual);
///     kkt.solve(right, step);
///
/// Requires numbers that are finite; others show in `smallest`. No allocation after construction. Nothing throws.

#include <lagroid/solvers/control/transcription.hpp>
#include <lagroid/solvers/linear_algebra/symmetric_factor_sized.hpp>

#include <vector>

namespace lagroid {

/// A vector of the KKT system: a displacement of the trajectory, and of the multipliers of its equalities.
struct KktVector {
  KktVector() = default;
  explicit KktVector(const TranscriptionSizes& sizes) : primal(sizes), multipliers(sizes.stages, sizes.equality) {}
  TrajectoryDisplacement primal;
  StageRows multipliers;
};

class StageKkt {
 public:
  explicit StageKkt(const Transcription& transcription);
  /// Of other rows than the transcription has, between the same ends.
  StageKkt(const Transcription& ends, const TranscriptionSizes& sizes);

  /// Which second derivatives of the stages' Lagrangians the matrix has.
  enum class HessianPart { exact, none };
  /// The matrix of these + sum_i sigma_i dgamma_i^T dgamma_i and of the equalities' derivatives. They are read where it
  /// is factored, stage by stage, so that what a stage needs is at hand; till then they stay as they are.
  void assemble(const StageDerivatives& derivatives, const StageRows& sigma,
                HessianPart hessian_part = HessianPart::exact);

  /// What a factorisation shows of the matrix.
  struct Inertia {
    long negative = 0;    ///< eigenvalues
    double smallest = 0;  ///< |pivot|
  };
  /// Factors with `primal` added to the diagonal of displacements and `dual` subtracted from that of the equalities'
  /// multipliers.
  Inertia factor(double primal, const StageRows& dual);
  /// The negative eigenvalues of the matrix at a minimum: one for each equality.
  long equalities() const;

  /// Solves the factored system, and again for what round-off has left, until that is little.
  void solve(const KktVector& right, KktVector& out);

 private:
  /// An unknown beside all stages: a component of v_0, or the duration of a phase.
  struct Beside {
    int component;
    int phase;  ///< -1: a component
  };
  static double& entry(TrajectoryDisplacement& x, const Beside& at) {
    return at.phase < 0 ? x.nodes[0][at.component] : x.durations[std::size_t(at.phase)];
  }
  static double entry(const TrajectoryDisplacement& x, const Beside& at) {
    return at.phase < 0 ? x.nodes[0][at.component] : x.durations[std::size_t(at.phase)];
  }

  /// Where v_{k+1} begins in y_k, behind controls and multipliers.
  int target_of(long stage) const { return sizes_.control + sizes_.equalities_of(stage); }
  int block_of(long stage) const { return target_of(stage) + sizes_.node; }
  int border_of_start(int component) const { return border_index_[std::size_t(component)]; }
  const double* stage_hessian(long stage);
  void assemble_stage(long stage);
  void pass_on(long stage, double* work);
  void eliminate_border(long stage);
  void keep_zero(long stage, int at);
  void take(const KktVector& right);
  enum class Solution { first, corrected };
  void eliminate(Solution which);
  void give(KktVector& out) const;
  void subtract_product();
  double largest_right() const;

  TranscriptionSizes sizes_;
  std::vector<bool> free_end_;
  std::vector<int> border_index_;     // of each component of v_0; -1 where it is fixed
  std::vector<int> duration_border_;  // of each phase
  std::vector<Beside> beside_;
  std::vector<int> columns_;  // of each stage: how many of the unknowns beside have begun
  int border_ = 0;            // how many there are
  int block_ = 0;             // of the largest y_k
  int row_ = 0;               // its length with padding

  const StageDerivatives* derivatives_ = nullptr;
  const StageRows* sigma_ = nullptr;
  HessianPart hessian_part_ = HessianPart::exact;
  double primal_ = 0;
  StageRows dual_;
  // Of each stage, padded rows: the transposed where a row belongs to an unknown of elsewhere.
  StageRows diagonal_;          // block rows
  StageRows coupling_;          // node rows: to v_k, of the stage before
  StageRows bordered_;          // a row for each unknown beside
  std::vector<double> corner_;  // border x border

  // Elimination goes by the inverses of pivot blocks: products wait for nothing, as substitutions do for each unknown.
  std::vector<SymmetricFactorSized> factors_;  // of each size of a block
  StageRows inverse_;                          // block rows
  StageRows border_solved_;                    // it times the border there
  SymmetricFactorSized corner_factor_;
  std::vector<double> corner_work_;
  std::vector<double> corner_inverse_;
  StageRows right_;       // right-hand sides, y_k
  StageRows eliminated_;  // on their way
  StageRows solution_;
  std::vector<double> border_right_;
  std::vector<double> border_eliminated_;
  std::vector<double> border_step_;
  std::vector<double> border_solution_;
  std::vector<double> hessian_;      // of a stage
  std::vector<double> no_hessian_;   // zeros
  std::vector<double> block_work_;   // block rows
  std::vector<double> passed_rows_;  // node rows: the v-part of a pivot block's inverse times the coupling
  std::vector<double> row_work_;
  std::vector<double> weights_;  // of a node
};

}  // namespace lagroid
