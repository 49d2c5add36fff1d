#pragma once
/// From an interior point to digits: which inequalities are active is read off a solution of the interior point method,
/// where s_i z_i is small but not zero, and Newton's method solves the equations that are left,
///
///     d(l + <lambda, phi> + <z, gamma>) = 0,    phi = 0,    gamma_i = 0 for i active,    z_i = 0 for the others.
///
/// What comes of it is complementary exactly, and stationary and feasible to round-off.
///
///     Crossover crossover(transcription);
///     const CrossoverReport report = crossover.cross(solver.costates(), solver.inequality_multipliers());
///     if (report.crossed()) use(crossover.costates(), crossover.inequality_multipliers());
///
/// The matrix is that of StageKkt with a row for each inequality, before phi; of one that is not active the row is
/// empty and its pivot -1, so that z_i stays zero and the inertia of a minimum is one negative eigenvalue a row as
/// ever. Where rows are dependent, or pivots vanish along the trajectory (every control at a bound, say), the diagonal
/// is shifted by a little: Newton's method then is a proximal one, of the same solutions.
///
/// An active inequality whose multiplier is negative is let go, one that is violated is taken in, and the equations are
/// solved again, a few times.
///
/// Requires the trajectory of a solution that converged. Where the report does not say `crossed`, the trajectory has
/// moved, to nowhere of use: keep that of before. No allocation after construction. Nothing throws.
///
/// Nocedal and Wright, Numerical Optimization (2006), 16.5 and 19.

#include <lagroid/solvers/control/optimality/kkt_residual.hpp>
#include <lagroid/solvers/control/stage_kkt.hpp>

#include <functional>
#include <string_view>
#include <vector>

namespace lagroid {

enum class CrossoverStatus {
  not_tried,     ///< the solve before it did not converge, or no crossover was asked for
  crossed,       ///< to a solution whose residual is smaller, or round-off
  degenerate,    ///< the active inequalities are not to be told, or the matrix has not the inertia of a minimum
  not_improved,  ///< the residual did not become smaller: from too far away
  interrupted,   ///< `keep_going` said so
};

constexpr std::string_view to_string(CrossoverStatus status) {
  switch (status) {
    case CrossoverStatus::not_tried:
      return "not_tried";
    case CrossoverStatus::crossed:
      return "crossed";
    case CrossoverStatus::degenerate:
      return "degenerate";
    case CrossoverStatus::not_improved:
      return "not_improved";
    case CrossoverStatus::interrupted:
      return "interrupted";
  }
  return "";
}

struct CrossoverReport {
  CrossoverStatus status = CrossoverStatus::not_tried;
  int iterations = 0;
  int changes = 0;     ///< of the active inequalities, after the first guess
  long active = 0;     ///< inequalities
  KktResidual before;  ///< of the interior point
  KktResidual after;
  double cost = 0;

  bool crossed() const { return status == CrossoverStatus::crossed; }
};

class Crossover {
 public:
  /// `keep_going` is asked in every iteration.
  explicit Crossover(Transcription& transcription, std::function<bool()> keep_going = {});

  CrossoverReport cross(const StageRows& costates, const StageRows& multipliers);

  const StageRows& costates() const { return costates_; }
  const StageRows& inequality_multipliers() const { return multipliers_; }

 private:
  enum class Outcome { solved, wrong_inertia, diverged, interrupted };

  CrossoverStatus attempt(double factor, CrossoverReport& report);
  void guess_active(double factor);
  Outcome solve_for_active(CrossoverReport& report);
  bool factor();
  void assemble();
  void step();
  void evaluate();
  KktResidual residual_of_active();
  bool change_active();
  char& active(long stage, int i) { return active_[std::size_t(stage * sizes_.inequality + i)]; }

  Transcription& transcription_;
  std::function<bool()> keep_going_;
  TranscriptionSizes sizes_;
  TranscriptionSizes padded_sizes_;  // with a row for each inequality among the equalities
  StageKkt kkt_;
  StageValues values_;
  StageDerivatives derivatives_;
  StageDerivatives padded_;
  StageRows costates_;
  StageRows multipliers_;
  StageRows slacks_;  // of the interior point
  std::vector<char> active_;
  StageRows no_inequalities_;
  StageRows dual_;
  TrajectoryDisplacement gradient_;
  KktVector right_;
  KktVector step_;
};

}  // namespace lagroid
