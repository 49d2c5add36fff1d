#pragma once
/// The KKT matrix of an optimal control problem with its elimination, linear in the number of stages:
///
///     unknowns of stage k:  y_k = (v_{k+1}, du_k, dlambda_k),    beside all stages:  (free ones of v_0, t_1, t_2 ...).
///
/// The matrix is block-tridiagonal but for the few unknowns beside all stages, which border it: these have no place
/// along the trajectory where their pivot would be safe. The duration of a phase has a column from where its phase
/// begins.
///
///     StageKkt kkt(transcription);
///     kkt.assemble(derivatives, sigma);
///     const StageKkt::Inertia inertia = kkt.factor(0, dual, &right);
///     kkt.solve_eliminated(right, step);
///
/// A trajectory of ten thousand stages is larger than a cache, and then most of the time goes by between memory and
/// processor. So the matrix is nowhere but in the stages' derivatives: a block is made where it is factored, right-hand
/// sides that are known are eliminated in the same pass, and so is what a solution leaves of them.
///
/// Requires numbers that are finite; others show in `smallest`. No allocation after construction. Nothing throws.

#include <lagroid/solvers/control/transcription.hpp>
#include <lagroid/solvers/linear_algebra/symmetric_factor_sized.hpp>

#include <array>
#include <cstddef>
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
  /// is factored and where it is solved: till then they stay as they are.
  void assemble(const StageDerivatives& derivatives, const StageRows& sigma,
                HessianPart hessian_part = HessianPart::exact);

  /// What a factorisation shows of the matrix.
  struct Inertia {
    long negative = 0;    ///< eigenvalues
    double smallest = 0;  ///< |pivot|
  };
  /// Factors with `primal` added to the diagonal of displacements and `dual` subtracted from that of the equalities'
  /// multipliers, which stays as it is till it is solved. Eliminates right-hand sides on its way, where they are given.
  Inertia factor(double primal, const StageRows& dual, const KktVector* right = nullptr);
  /// The negative eigenvalues of the matrix at a minimum: one for each equality.
  long equalities() const;

  /// Solves the factored system, and again for what round-off has left, until that is little. Not in place.
  void solve(const KktVector& right, KktVector& out);
  /// The same of right-hand sides that were given to `factor`.
  void solve_eliminated(const KktVector& right, KktVector& out);

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

  /// What a stage's part of the matrix makes of a vector.
  struct Product {
    std::vector<double> primal;  ///< of the stage's variables
    std::vector<double> equality;
  };

  int block_of(long stage) const { return displaced_ + sizes_.equalities_of(stage); }
  int border_of_start(int component) const { return border_index_[std::size_t(component)]; }
  template <class What> void for_fixed(long stage, std::size_t phase, const What& what) const;
  const double* stage_hessian(long stage);
  void assemble_stage(long stage, std::size_t phase, const double* hessian, const double* next);
  template <class Column>
  void assemble_border(long stage, std::size_t phase, const double* hessian, const double* next, const Column& column);
  void pass_on(long stage);
  void eliminate_border(long stage);
  const Product& product(long stage, std::size_t phase, const KktVector& x);
  void begin_elimination(const KktVector& right, const KktVector* solved);
  void eliminate(long stage, std::size_t phase, const KktVector& right, const KktVector* solved);
  void end_elimination();
  void eliminate_all(const KktVector& right, const KktVector* solved);
  enum class Solution { first, corrected };
  void substitute(Solution which, KktVector& out);

  TranscriptionSizes sizes_;
  std::vector<bool> free_end_;
  std::vector<int> border_index_;     // of each component of v_0; -1 where it is fixed
  std::vector<int> duration_border_;  // of each phase
  std::vector<Beside> beside_;
  std::vector<int> columns_;  // of each stage: how many of the unknowns beside have begun
  int border_ = 0;            // how many there are
  int displaced_ = 0;         // of y_k, before the multipliers
  int row_ = 0;               // the length of the largest y_k with padding

  const StageDerivatives* derivatives_ = nullptr;
  const StageRows* sigma_ = nullptr;
  HessianPart hessian_part_ = HessianPart::exact;
  double primal_ = 0;
  const StageRows* dual_ = nullptr;

  // Elimination goes by the inverses of pivot blocks: products wait for nothing, as substitutions do for each unknown.
  // Of each stage, padded rows: the transposed where a row belongs to an unknown of elsewhere.
  StageRows coupling_;                         // node rows: to v_k, of the stage before
  std::vector<SymmetricFactorSized> factors_;  // of each count of equalities
  StageRows inverse_;                          // block rows
  StageRows border_solved_;                    // a row for each unknown beside: it times the border there
  std::vector<double> corner_;                 // border x border
  SymmetricFactorSized corner_factor_;
  std::vector<double> corner_inverse_;
  StageRows eliminated_;  // y_k: right-hand sides through the inverses, then the solution
  double largest_ = 0;    // of the right-hand sides
  std::vector<double> border_right_;
  std::vector<double> border_eliminated_;
  std::vector<double> border_step_;

  // Of a stage, or of two in succession.
  std::array<Product, 2> products_;
  std::array<std::vector<double>, 2> hessians_;
  std::vector<double> no_hessian_;   // zeros
  std::vector<double> block_work_;   // block rows
  std::vector<double> passed_rows_;  // node rows: the v-part of a pivot block's inverse times the coupling
  std::vector<double> row_work_;
  std::vector<double> weights_;  // of a node
  std::vector<double> along_;    // of the stage's variables
};

}  // namespace lagroid
