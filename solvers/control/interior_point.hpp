#pragma once
/// A primal-dual interior point method on the manifold of trajectories: slacks s > 0 turn gamma <= 0 into gamma + s =
/// 0, and Newton's method solves, for a sequence mu -> 0,
///
///     d(l + <lambda, phi> + <z, gamma>) = 0,    phi = 0,    gamma + s = 0,    s_i z_i = mu.
///
/// Its unknowns are displacements of nodes and controls, so that no chart and no norm of a quaternion is in the way,
/// and an iteration costs O(N).
///
///     InteriorPoint solver(transcription);
///     const ControlReport found = solver.solve();  // from the trajectory as it stands
///     if (!found.converged()) std::cerr << found.message;
///
/// Requires a trajectory whose ends are those of the problem; it need satisfy no constraint. Returns a ControlReport;
/// where it is not `converged` the trajectory is the last iterate, and `worst` lists what is violated most. No
/// allocation in an iteration but of the filter's entries beyond a thousand. Nothing throws.
///
/// Waechter and Biegler, Math. Program. 106 (2006): filter, inertia correction, second-order corrections; the
/// restoration is a primal-dual iteration on the smoothed sum of violations. What rounding leaves of a constraint or of
/// the gradient (KktRounding) is no violation and no residual, whatever the units.

#include <lagroid/solvers/control/optimality/curvature.hpp>
#include <lagroid/solvers/control/optimality/kkt_residual.hpp>
#include <lagroid/solvers/control/optimality/repeated_constraints.hpp>
#include <lagroid/solvers/control/stage_kkt.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid {

enum class ControlStatus {
  converged,
  infeasible,  ///< a stationary point of the violation: near it no trajectory satisfies the constraints
  stagnated,   ///< of a trajectory that satisfies the constraints, no step is better: rounding, or a degenerate minimum
  not_converged,  ///< the iterations are used up
  singular,       ///< no shift of the matrix gave a direction
  redundant,      ///< it failed, and constraints repeat each other (`repeated`): leave these out first
  not_finite,     ///< a value at the start
  interrupted     ///< `keep_going` said so
};

constexpr std::string_view to_string(ControlStatus status) {
  switch (status) {
    case ControlStatus::converged:
      return "converged";
    case ControlStatus::infeasible:
      return "infeasible";
    case ControlStatus::stagnated:
      return "stagnated";
    case ControlStatus::not_converged:
      return "not_converged";
    case ControlStatus::singular:
      return "singular";
    case ControlStatus::redundant:
      return "redundant";
    case ControlStatus::not_finite:
      return "not_finite";
    case ControlStatus::interrupted:
      return "interrupted";
  }
  return "";
}

struct ControlOptions {
  int max_iterations = 500;
  double tolerance = 1e-10;       ///< on every part of the KKT residual, relative to the multipliers' mean size
  double first_barrier = 0.1;     ///< mu, at first
  double least_slack = 1e-2;      ///< of an inequality at the start
  double resumed_barrier = 1e-4;  ///< mu, at first, where `resume` goes on
  bool crossover = true;          ///< whether `solve_control` goes on to the active inequalities (crossover.hpp)
  std::function<bool()> keep_going = {};  ///< asked in every iteration; false ends with the last iterate
};

/// A constraint that is violated: row `row` of phi (equality) or gamma at a stage.
struct ConstraintViolation {
  long stage = 0;
  int row = 0;
  bool is_equality = false;
  double amount = 0;
};

struct ControlReport {
  ControlStatus status = ControlStatus::not_converged;
  int iterations = 0;    ///< restoration included
  int restorations = 0;  ///< how often it was called
  int factorisations = 0;
  double cost = 0;
  // The KKT residual as it stands, not scaled (KktResidual).
  double stationarity = 0;                   ///< largest component of the Lagrangian's gradient
  double violation = 0;                      ///< largest of |phi| and of gamma's positive part
  double complementarity = 0;                ///< largest |z_i gamma_i|
  Curvature curvature = Curvature::open;     ///< of what converged
  std::vector<ConstraintViolation> worst;    ///< of a trajectory that is infeasible, the largest five
  std::vector<RepeatedConstraint> repeated;  ///< converged or not: what could be left out (repeated_constraints.hpp)
  std::string message;                       ///< where it is not converged: what to do

  bool converged() const { return status == ControlStatus::converged; }
  bool is_strict_minimum() const { return curvature == Curvature::strict_minimum; }
  bool is_saddle() const { return curvature == Curvature::saddle; }
  /// Whether a trajectory that did not converge satisfies its constraints so well that it may be followed.
  bool is_usable(double most_violated) const {
    return status != ControlStatus::not_finite && violation <= most_violated;
  }
};

class InteriorPoint {
 public:
  explicit InteriorPoint(Transcription& transcription, ControlOptions options = {});

  ControlReport solve();
  /// After a solve that ended at a saddle: on to what costs less. Where that does not converge, the trajectory is at
  /// its last iterate, no longer at the saddle. Iterations count on.
  ControlReport leave_saddle();
  /// The same from a trajectory that is near one that was solved, with the multipliers as they are: for the next sample
  /// of a control loop. At most so many iterations; a report without words, for it allocates nothing.
  ControlReport resume(int most_iterations);
  /// The multipliers of stage k + 1 become those of stage k, of a horizon that has moved on; the last stage keeps its.
  void move_on();
  /// Those of a solution that is known, for `resume`.
  void take_multipliers(const StageRows& costates, const StageRows& of_inequalities);

  /// The costates lambda of the equalities, and the multipliers z >= 0 of the inequalities, at the trajectory.
  const StageRows& costates() const { return costates_; }
  const StageRows& inequality_multipliers() const { return multipliers_; }

 private:
  struct Merit {
    double violation = 0;  // sum of |phi| and |gamma + s|
    double barrier = 0;    // cost - mu sum log s
    bool finite() const;
  };
  enum class Outcome { advanced, stuck };

  void begin();
  void begin_again();
  void iterate(int most_iterations);
  bool goes_on();
  void evaluate();
  Merit merit(const StageValues& values, const StageRows& slacks) const;
  double scaled_error(double barrier);
  double smoothed_violation(const StageValues& at, double nu) const;
  bool factor(const KktVector& right);
  bool direction();
  void newton_side(const StageRows& equality, const StageRows& inequality_gap);
  double change_of_inequality(long stage, int i) const;
  void slack_directions(const StageRows& inequality_gap);
  double fraction_to_boundary(const StageRows& at, const StageRows& along) const;
  /// How much of the step is tried at most: slacks stay positive, and free durations of their size.
  double largest_fraction() const;
  double slope() const;
  Outcome line_search();
  double merit_rounding(const Merit& now) const;
  void add_to_filter(const Merit& now);
  void take_trial(const Merit& now, const Merit& trial, double slope, double fraction);
  bool take_corrected(const Merit& now, double slope, double fraction);
  Merit try_step(double fraction);
  bool accepted_by_filter(const Merit& trial) const;
  bool acceptable(const Merit& now, const Merit& trial, double slope, double fraction) const;
  void take(double fraction);
  bool restore();
  void least_squares_costates();
  void update_barrier();
  double least_curvature();
  bool fall();
  void judge();
  void describe();
  void explain();

  Transcription& transcription_;
  ControlOptions options_;
  TranscriptionSizes sizes_;
  StageKkt kkt_;
  StageValues values_;
  StageValues trial_;
  StageDerivatives derivatives_;
  StageRows costates_;
  StageRows multipliers_;
  StageRows slacks_;
  StageRows trial_slacks_;
  StageRows sigma_;
  StageRows weights_;
  StageRows dual_;
  StageRows slack_step_;
  StageRows multiplier_step_;
  StageRows equality_;               // what a direction is to correct: phi, or phi with a second-order correction
  StageRows gap_;                    // gamma + s, likewise
  TrajectoryDisplacement gradient_;  // of the Lagrangian, where the trajectory stands
  KktVector right_;
  KktVector step_;
  KktVector first_step_;  // before a second-order correction
  StageRows first_slack_step_;
  KktRounding rounding_;  // where the derivatives were evaluated

  double barrier_ = 0;
  double shift_ = 0;       // of the displacements' diagonal, in the last factorisation
  double last_shift_ = 0;  // the last that was not zero
  double merit_rounding_ = 0;
  bool gains_rounding_ = false;  // the last step, and no more
  std::vector<Merit> filter_;
  double largest_allowed_ = 0;  // violation
  double small_violation_ = 0;
  int most_iterations_ = 0;
  ControlReport report_;
};

}  // namespace lagroid
